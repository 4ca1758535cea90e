#pragma once
// Answers of a cache in the picture's units.

#include <span>

#include "neural/trainer.h"
#include "renderer/cache/record_batch.h"
#include "renderer/cache/surface_points.h"

namespace gatelight::renderer {

/// Fills `answers`: as many floats for each point as the network has outputs. Outputs that are negative or
/// not finite become zero; returns the number of points that have one.
std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers);

}  // namespace gatelight::renderer
