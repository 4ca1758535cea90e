#pragma once

#include <map>
#include <vector>

namespace gatelight::scene::gltf {

/// Renumbers the objects that are used, in the order of their first use.
class Numbering {
 public:
  int number_of(int original) {
    const auto [entry, is_new] = numbers_.try_emplace(original, static_cast<int>(order_.size()));
    if (is_new) order_.push_back(original);
    return entry->second;
  }
  const std::vector<int>& order() const { return order_; }

 private:
  std::map<int, int> numbers_;
  std::vector<int> order_;
};

}  // namespace gatelight::scene::gltf
