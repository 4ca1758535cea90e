#pragma once
// The light of earlier frames, carried to the surfaces that the present frame shows. It is denoised: noise of
// samples that is carried becomes streaks, which the denoiser takes for detail.

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
  std::vector<float> color;    ///< 3 floats a pixel: denoised
  std::vector<float> albedo;   ///< 3 floats a pixel: of the guides
  std::vector<float> samples;  ///< 1 float a pixel: their number, with those taken over
  std::vector<float> probes;   ///< probe_light(); empty where nothing but the camera moves
};

struct Reuse {
  VisiblePoints points;
  std::vector<float> probes;   ///< of the points
  std::vector<float> color;    ///< 3 floats a pixel: the mean of the film's samples and those taken over
  std::vector<float> samples;  ///< 1 float a pixel: their number
  double share = 0.0;          ///< of the pixels that took samples over
};

/// Most samples that a pixel takes over, in those that the frame itself has: more hold light longer still,
/// but follow its changes later.
inline constexpr float kMostEarlier = 12.0f;

/// Takes over samples where the earlier frame shows the same surface in the same light. The light without the
/// surface's colour is carried. `probes`: of the points; empty where nothing but the camera moves. Works in
/// the caller's arena.
Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<float> probes,
                    const History& history);

}  // namespace gatelight::renderer
