#include "renderer/cache/cache_query.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace gatelight::renderer {

std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  trainer.query(points.batch(), {.precision = precision, .range = neural::OutputRange::raw}, answers);
  const std::size_t outputs = trainer.model().config.mlp.outputs;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, points.size(), 4096), std::uint64_t{0},
      [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t negative) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          bool below = false;
          for (float& a : answers.subspan(outputs * i, outputs)) {
            if (!(a >= 0.0f && a <= kGreatest)) {
              below = true;
              a = 0.0f;
            }
            a = std::min(a * units.scale, units.greatest);
          }
          if (below) ++negative;
        }
        return negative;
      },
      std::plus<>());
}

}  // namespace gatelight::renderer
