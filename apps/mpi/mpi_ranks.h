#pragma once
// Ranks by MPI: processes that mpirun started, on one machine or on many.

#include <memory>
#include <string>
#include <vector>

#include "apps/mpi/callbacks.h"
#include "renderer/ranks/ranks.h"

namespace gatelight::apps {

/// One at a time in a process. Where mpirun has not started it, the process is alone.
class MpiRanks final : public renderer::Ranks {
 public:
  using Callbacks = RankCallbacks;

  /// Starts MPI. Throws std::runtime_error where it cannot be used. A rank of which nothing is heard for
  /// `silence_seconds` is lost, and with it the run.
  MpiRanks(int* argc, char*** argv, Callbacks callbacks, double silence_seconds = 20.0);
  /// Like end(), but an exception that passes by or a failure ends all ranks.
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override;
  int count() const override;
  int local_count() const;  ///< ranks of this machine
  const std::string& host(int rank) const;

  std::vector<renderer::Bytes> exchange(std::vector<renderer::Bytes> outgoing) override;
  void broadcast(renderer::Bytes& bytes) override;
  std::unique_ptr<Gathering> begin_gather(renderer::Bytes mine) override;
  Traffic traffic() const override;

  /// This rank ends with an error. Where all ranks say the same within a second, the line is printed once,
  /// and each of them returns and is to end with the code. Else the program ends here, and all ranks with it.
  void fail(int code, const std::string& line);

  /// All ranks call it when they are done, or when fail() has returned. It waits for the others and stops
  /// MPI.
  void end();

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace gatelight::apps
