#include "apps/frame_settings.h"

#include <algorithm>
#include <cmath>

namespace gatelight::apps {

renderer::CameraOptions camera_of_frame(const RenderSettings& settings, int frame) {
  renderer::CameraOptions camera = settings.render.camera;
  const int turn = settings.frames.turntable;
  // In double, and modulo a whole turn: the frames of the second turn are those of the first.
  if (turn > 0) {
    const ShutterRange& shutter = settings.frames.shutter;
    const double each = 2.0 * M_PI / turn;
    camera.turn = static_cast<float>(each * ((frame % turn + turn) % turn + shutter.middle()));
    camera.turn_in_shutter = static_cast<float>(each * (shutter.closes - shutter.opens));
  }
  return camera;
}

RenderSettings settings_of_frame(const RenderSettings& whole, int frame) {
  RenderSettings settings = whole;
  settings.load.time = whole.frames.seconds(frame);
  settings.render.checkpoint = {};
  settings.render.cache.cache_out.clear();
  settings.frames.range = FrameList{{{frame, frame}}};
  settings.render.camera = camera_of_frame(whole, frame);
  if (whole.exposure) settings.image.display.exposure = *whole.exposure;
  for (std::string& output : settings.outputs) output = name_of_frame(output, frame);
  settings.stats = name_of_frame(settings.stats, frame);
  return settings;
}

std::vector<int> scouted_frames(const std::vector<int>& frames) {
  constexpr std::size_t kScouted = 8;
  const std::size_t moments = std::min(frames.size(), kScouted);
  const std::size_t steps = std::max<std::size_t>(moments, 2) - 1;
  std::vector<int> scouted;
  for (std::size_t k = 0; k < moments; ++k) scouted.push_back(frames[k * (frames.size() - 1) / steps]);
  return scouted;
}

}  // namespace gatelight::apps
