#pragma once
// The light of earlier frames, carried to the surfaces that the present frame shows. Both are denoised first.

#include <cstddef>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/reuse/visible_points.h"

namespace gatelight::renderer {

/// A frame, with the samples that it took over from those before.
struct History {
  EarlierView view;
  PixelRect rect;
  std::vector<VisiblePoint> points;
  std::vector<float> color;    ///< 3 floats a pixel: the finished light
  std::vector<float> samples;  ///< 1 float a pixel: their number, with those taken over; 0 near edges
  std::vector<float> probes;   ///< probe_light(); empty where nothing but the camera moves
};

struct Reuse {
  VisiblePoints points;
  std::vector<float> probes;   ///< of the points
  std::vector<float> color;    ///< 3 floats a pixel: the carried light; empty: there is none
  std::vector<float> weight;   ///< 1 float a pixel: its share in the mean with the frame's samples
  std::vector<float> samples;  ///< 1 float a pixel: their number together; 0 near edges
  double share = 0.0;          ///< of the pixels that took samples over
};

/// Most samples that a pixel takes over, in those that the frame itself has: more hold light longer still,
/// but follow its changes later.
inline constexpr float kMostEarlier = 12.0f;

/// Finds the light where the earlier frame shows the same surface in the same light. `probes`: of the points;
/// empty where nothing but the camera moves. `history`: null for none. Works in the caller's arena.
Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<float> probes,
                    const History* history);

/// Mixes the carried light into a denoised frame: 3 floats for each pixel of `rect`. Means over some pixels
/// take it by its weight; what is finer stays mostly that of the frame, because each time it is carried it is
/// interpolated. Works in the caller's arena.
void mix_light(const Reuse& reuse, const PixelRect& rect, std::vector<float>& denoised);

}  // namespace gatelight::renderer
