#include "renderer/cache/cache_query.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/parallel/loops.h"

namespace gatelight::renderer {

std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  trainer.query(points.batch(), {.precision = precision, .range = neural::OutputRange::raw}, answers);
  const std::size_t outputs = trainer.model().config.mlp.outputs;
  std::atomic<std::uint64_t> negative = 0;
  for_each_range(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::uint64_t here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      bool below = false;
      for (float& a : answers.subspan(outputs * i, outputs)) {
        if (!(a >= 0.0f && a <= kGreatest)) {
          below = true;
          a = 0.0f;
        }
        a = std::min(a * units.scale, units.greatest);
      }
      if (below) ++here;
    }
    if (here > 0) negative += here;
  });
  return negative;
}

}  // namespace gatelight::renderer
