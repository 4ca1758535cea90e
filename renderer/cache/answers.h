#pragma once
// What the network says, in the picture's units.

#include <cstdint>
#include <limits>
#include <span>

#include "neural/trainer.h"
#include "renderer/cache/surface_points.h"

namespace gatelight::renderer {

/// An answer is the network's output times `scale`, at most `greatest`.
struct AnswerUnits {
  float scale = 1.0f;
  float greatest = std::numeric_limits<float>::max();
};

/// As many floats for each point as the network has outputs. Not finite or negative ones become zero; the
/// result is the number of points that have one.
std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers);

}  // namespace gatelight::renderer
