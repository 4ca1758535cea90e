#pragma once
// Samples an index by weight in constant time: Walker's alias method, built by Vose's algorithm (1991).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::renderer {

class AliasTable {
 public:
  AliasTable() = default;

  /// Weights are finite and not negative. When all are zero, the table is empty.
  explicit AliasTable(std::span<const double> weights) {
    double sum = 0.0;
    for (const double w : weights) sum += w;
    if (!(sum > 0.0)) return;
    const std::size_t count = weights.size();
    entries_.resize(count);
    std::vector<double> scaled(count);
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::size_t i = 0; i < count; ++i) {
      entries_[i].probability = static_cast<float>(weights[i] / sum);
      entries_[i].alias = static_cast<std::uint32_t>(i);
      scaled[i] = weights[i] / sum * static_cast<double>(count);
      (scaled[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
    }
    while (!small.empty() && !large.empty()) {
      const std::uint32_t low = small.back();
      const std::uint32_t high = large.back();
      small.pop_back();
      entries_[low].threshold = scaled[low];
      entries_[low].alias = high;
      scaled[high] -= 1.0 - scaled[low];
      if (scaled[high] < 1.0) {
        large.pop_back();
        small.push_back(high);
      }
    }
    // The remaining entries have a scaled weight of one except for rounding. Only an entry with weight zero
    // would be wrong.
    const auto heaviest =
        static_cast<std::uint32_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
    for (const std::uint32_t i : small) {
      if (!(weights[i] > 0.0)) entries_[i] = {0.0, entries_[i].probability, heaviest};
    }
  }

  bool empty() const { return entries_.empty(); }

  /// u is in [0, 1). The returned index has a weight above zero.
  std::uint32_t sample(double u) const {
    const double scaled = u * static_cast<double>(entries_.size());
    const std::size_t i = std::min(static_cast<std::size_t>(scaled), entries_.size() - 1);
    const Entry& entry = entries_[i];
    return scaled - static_cast<double>(i) < entry.threshold ? static_cast<std::uint32_t>(i) : entry.alias;
  }
  float probability(std::uint32_t index) const { return entries_[index].probability; }
  std::size_t bytes() const { return entries_.size() * sizeof(Entry); }

 private:
  struct Entry {
    double threshold = 1.0;  ///< below it the entry itself is chosen, otherwise its alias
    float probability = 0.0f;
    std::uint32_t alias = 0;
  };
  std::vector<Entry> entries_;
};

}  // namespace gatelight::renderer
