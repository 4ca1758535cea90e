#pragma once
// Exchanges that progress while the ranks compute: a thread calls advance() regularly.

#include <deque>
#include <exception>
#include <memory>
#include <vector>

#include "apps/mpi/mpi_world.h"
#include "renderer/distributed/packing.h"

namespace gatelight::apps {

/// The caller holds the mutex.
class Exchange {
 public:
  /// `outgoing`: of each rank, or one for all.
  Exchange(const MpiGroup& group, std::vector<renderer::Bytes> outgoing);

  /// Takes at most one step, because the next one may take long: it allocates the buffers.
  void advance();
  /// Whether it has ended, with or without success.
  bool over() const { return step_ == Step::over; }
  bool failed() const { return error_ != nullptr; }
  std::uint64_t bytes_sent() const;
  /// Returns the bytes in the order of ranks. Throws the exception that made the exchange fail.
  std::vector<renderer::Bytes> take();

 private:
  enum class Step { begin, sizes, bytes, over };

  renderer::Bytes& bytes_to(int rank);
  void next_step();
  void begin_bytes();

  const MpiGroup& group_;
  std::vector<renderer::Bytes> outgoing_, incoming_;
  std::vector<std::uint64_t> outgoing_sizes_, incoming_sizes_;
  Requests requests_;
  Step step_ = Step::begin;
  std::exception_ptr error_;
};

/// The caller holds the mutex.
class Exchanges {
 public:
  explicit Exchanges(const MpiGroup& group) : group_(group) {}

  /// Returns at once. Exchanges run one after the other.
  std::shared_ptr<Exchange> begin(std::vector<renderer::Bytes> outgoing);
  void advance();
  bool idle() const { return waiting_.empty(); }

 private:
  const MpiGroup& group_;
  std::deque<std::shared_ptr<Exchange>> waiting_;  ///< the first one runs
  std::vector<std::shared_ptr<Exchange>> failed_;  ///< kept, because MPI may still use their memory
};

}  // namespace gatelight::apps
