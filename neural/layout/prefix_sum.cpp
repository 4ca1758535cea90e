#include "neural/layout/prefix_sum.h"

#include <tbb/parallel_scan.h>

#include "neural/layout/index_range.h"

namespace gatelight::neural {

void inclusive_prefix_sum(std::vector<std::uint32_t>& values) {
  tbb::parallel_scan(
      IndexRange(0, values.size(), 65536), std::uint32_t{0},
      [&](const IndexRange& range, std::uint32_t sum, bool final) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          sum += values[i];
          if (final) values[i] = sum;
        }
        return sum;
      },
      [](std::uint32_t a, std::uint32_t b) { return a + b; });
}

}  // namespace gatelight::neural
