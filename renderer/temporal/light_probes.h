#pragma once
// The light of the same few lamp points and directions in every frame: it tells changes of the light without
// noise.

#include <vector>

#include "renderer/temporal/visible_points.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// For each point the mean radiance that an ideal white surface would reflect, of some light samples and some
/// directions with one bounce. All points use the same random numbers, so where nothing has changed it is the
/// same a frame later, and nearly the same at points nearby (after Schied, Peters, Dachsbacher 2018,
/// "Gradient estimation for real-time adaptive temporal filtering"). 0 without a surface. Works in the
/// caller's arena.
std::vector<Color> probe_light(const World& world, const std::vector<VisiblePoint>& points);

}  // namespace gatelight::renderer
