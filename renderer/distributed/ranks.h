#pragma once
// The interface of a process to the others that make one picture with it. An application implements it, for
// example with MPI; without that there is one process.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "renderer/distributed/packing.h"

namespace gatelight::renderer {

struct Traffic {
  std::uint64_t bytes_sent = 0;
  double waiting_seconds = 0.0;  ///< in the functions of Ranks
};

/// All ranks call the same functions in the same order. They run the same program on machines of the same
/// kind, so values are sent as they are in memory. The functions are called by one thread at a time. They
/// throw where the connection fails.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const { return 0; }   ///< from 0
  virtual int count() const { return 1; }  ///< at least 1
  bool first() const { return rank() == 0; }
  bool is_single() const { return count() == 1; }

  /// Bytes on their way.
  class Exchange {
   public:
    virtual ~Exchange() = default;
    /// Waits for them. Returns what each rank gave to this one, in the order of ranks. Call it once.
    virtual std::vector<Bytes> wait() = 0;
  };
  /// Gives outgoing[r] to rank r, or the only entry to all ranks. The caller may go on with its work and call
  /// the other functions until it waits for the result.
  virtual std::unique_ptr<Exchange> begin_exchange(std::vector<Bytes> outgoing);
  std::vector<Bytes> exchange(std::vector<Bytes> outgoing) {
    return begin_exchange(std::move(outgoing))->wait();
  }
  /// Gives `mine` to all ranks.
  std::unique_ptr<Exchange> begin_gather(Bytes mine);
  std::vector<Bytes> gather(Bytes mine) { return begin_gather(std::move(mine))->wait(); }

  /// Replaces `bytes` by those of rank 0.
  virtual void broadcast(Bytes& bytes) { bytes = gather(first() ? std::move(bytes) : Bytes())[0]; }

  // The same for values, which are numbers or structs of numbers without pointers.

  /// The values of all ranks, one after the other.
  template <class T>
  std::vector<T> joined(std::vector<T> mine) {
    if (is_single()) return mine;
    return unpacked<T>(gather(packed(mine)));
  }
  /// The same for rank 0; the others get nothing.
  template <class T>
  std::vector<T> joined_at_first(std::vector<T> mine) {
    if (is_single()) return mine;
    std::vector<Bytes> outgoing(static_cast<std::size_t>(count()));
    outgoing[0] = packed(mine);
    return unpacked<T>(exchange(std::move(outgoing)));
  }
  /// One value of each rank.
  template <class T>
  std::vector<T> of_each(const T& mine) {
    return joined(std::vector<T>{mine});
  }
  /// Rank 0's value, broadcast to all.
  template <class T>
  T agreed(T mine) {
    if (is_single()) return mine;
    Bytes bytes = packed(std::span(&mine, 1));
    broadcast(bytes);
    return Unpacker(bytes).read<T>();
  }
  /// Whether `mine` is true at any rank.
  bool any(bool mine) { return sum(std::uint64_t{mine}) > 0; }
  template <class T>
  T sum(const T& mine) {
    T all{};
    for (const T& one : of_each(mine)) all += one;
    return all;
  }

  virtual Traffic traffic() const { return {}; }
};

/// These, or a single process where there are none.
Ranks& ranks_or_one(Ranks* ranks);

}  // namespace gatelight::renderer
