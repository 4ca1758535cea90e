#pragma once
// The light of earlier frames, carried to the surfaces that the present frame shows. Both are denoised first.

#include <vector>

#include "renderer/film/film.h"
#include "renderer/temporal/carried_light.h"
#include "renderer/temporal/visible_points.h"

namespace gatelight::renderer {

/// A frame, with the samples that it took over from those before.
struct History {
  PreviousView view;
  PixelRect rect;
  std::vector<VisiblePoint> points;
  std::vector<float> color;    ///< 3 floats a pixel: the finished light
  std::vector<float> samples;  ///< 1 float a pixel: their number, with those taken over; 0 near edges
  std::vector<Color> probes;   ///< probe_light(); empty where nothing but the camera moves
};

struct Reuse : CarriedLight {
  VisiblePoints points;
  std::vector<Color> probes;  ///< of the points
};

/// Finds the light where the earlier frame shows the same surface in the same light. `probes`: of the points;
/// empty where nothing but the camera moves. `history`: null for none. Works in the caller's arena.
Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<Color> probes,
                    const History* history);

}  // namespace gatelight::renderer
