#pragma once
// Notices that the light has changed since a cache learned it.

#include <span>

#include "renderer/cache/record_batch.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Below this change a cache fits the light.
inline constexpr double kUnchangedLight = 0.02;

/// The systematic error of answers, by targets that they have not learned from: the mean over the records of
/// the relative error of small cells of the scene, where that is large and certain, or the error of all
/// together, where that is more. It is zero for right answers, and one where all lamps went off. `outputs`
/// answers for each record of the group, in the units of its targets.
double light_change(const scene::Scene& scene, const RecordBatch& group, std::span<const float> answers,
                    std::size_t outputs);

}  // namespace gatelight::renderer
