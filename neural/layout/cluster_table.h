#pragma once
// A set of 64-bit keys that several threads fill. Its content does not depend on the order of insertion; the
// slot of a key does.

#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

namespace gatelight::neural {

class ClusterTable {
 public:
  enum class Inserted : std::uint8_t { known, fresh, full };
  struct Place {
    std::uint64_t slot = 0;
    Inserted inserted = Inserted::full;
  };

  /// Allocates at least twice as many slots as `keys`, so that probing stays short.
  explicit ClusterTable(std::uint64_t keys) : slots_(std::bit_ceil(2 * keys + 2)) {}

  /// Inserts a key, which must not be 0.
  Place insert(std::uint64_t key) {
    const std::uint64_t mask = slots_.size() - 1;
    for (std::uint64_t probe = 0; probe < slots_.size(); ++probe) {
      const std::uint64_t at = (key + probe) & mask;
      std::uint64_t there = slots_[at].load(std::memory_order_relaxed);
      if (there == 0 && slots_[at].compare_exchange_strong(there, key, std::memory_order_relaxed))
        return {at, Inserted::fresh};
      if (there == key) return {at, Inserted::known};
    }
    return {};
  }

  std::uint64_t size() const { return slots_.size(); }

 private:
  std::vector<std::atomic<std::uint64_t>> slots_;  ///< 0 means free
};

}  // namespace gatelight::neural
