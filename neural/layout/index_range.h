#pragma once
// Ranges of indices, for oneTBB.

#include <tbb/blocked_range.h>

#include <cstddef>

namespace gatelight::neural {

using IndexRange = tbb::blocked_range<std::size_t>;

}  // namespace gatelight::neural
