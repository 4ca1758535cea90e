#include "neural/layout/prefix_sum.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_scan.h>

namespace gatelight::neural {

void inclusive_prefix_sum(std::vector<std::uint32_t>& values) {
  tbb::parallel_scan(
      tbb::blocked_range<std::size_t>(0, values.size(), 65536), std::uint32_t{0},
      [&](const tbb::blocked_range<std::size_t>& range, std::uint32_t sum, bool final) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          sum += values[i];
          if (final) values[i] = sum;
        }
        return sum;
      },
      [](std::uint32_t a, std::uint32_t b) { return a + b; });
}

}  // namespace gatelight::neural
