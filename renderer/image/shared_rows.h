#pragma once
// A picture whose rows several processes share.

#include <functional>
#include <utility>
#include <vector>

namespace gatelight::renderer {

/// The rows first <= y < end of a picture are this process's; other processes have the others.
struct SharedRows {
  int first = 0;
  int end = 0;
  int top = 0;     ///< the first row of the data at hand, which has a margin around these
  int bottom = 0;  ///< its end
  int height = 0;  ///< of the whole picture
  /// Returns the numbers of all processes, those of the upper rows first. All call it at the same time.
  std::function<std::vector<double>(std::vector<double>)> join;

  /// One process has all.
  static SharedRows all(int height) {
    return {0, height, 0, height, height, [](std::vector<double> mine) { return mine; }};
  }
};

}  // namespace gatelight::renderer
