#pragma once
// A set of 64-bit keys that many threads fill, and the least vertex seen with each key: what it holds in the
// end does not depend on the order of insertion.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

namespace gatelight::neural {

class ClusterTable {
 public:
  struct Slot {
    std::atomic<std::uint64_t> key = 0;  ///< 0: free
    std::atomic<std::uint64_t> value = ~std::uint64_t{0};
  };
  enum class Inserted : std::uint8_t { known, fresh, full };

  /// Room for `keys` keys and as many again, so that searches stay short.
  explicit ClusterTable(std::uint64_t keys) : slots_(std::bit_ceil(2 * keys + 2)) {}

  Inserted insert(std::uint64_t key, std::uint64_t vertex) {
    const std::uint64_t mask = slots_.size() - 1;
    for (std::uint64_t probe = 0; probe < slots_.size(); ++probe) {
      Slot& slot = slots_[(key + probe) & mask];
      std::uint64_t there = slot.key.load(std::memory_order_relaxed);
      const bool fresh =
          there == 0 && slot.key.compare_exchange_strong(there, key, std::memory_order_relaxed);
      if (!fresh && there != key) continue;
      std::uint64_t least = slot.value.load(std::memory_order_relaxed);
      while (vertex < least && !slot.value.compare_exchange_weak(least, vertex, std::memory_order_relaxed)) {
      }
      return fresh ? Inserted::fresh : Inserted::known;
    }
    return Inserted::full;
  }

  /// The value of a key that was inserted.
  std::uint64_t value(std::uint64_t key) const {
    const std::uint64_t mask = slots_.size() - 1;
    for (std::uint64_t at = key & mask;; at = (at + 1) & mask)
      if (slots_[at].key.load(std::memory_order_relaxed) == key)
        return slots_[at].value.load(std::memory_order_relaxed);
  }

  std::vector<Slot>& slots() { return slots_; }

 private:
  std::vector<Slot> slots_;
};

}  // namespace gatelight::neural
