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

/// Fills `answers`: as many floats for each point as the network has outputs. Outputs that are negative or
/// not finite become zero; returns the number of points that have one.
std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers);

}  // namespace gatelight::renderer
