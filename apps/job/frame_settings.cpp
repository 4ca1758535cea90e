#include "apps/job/frame_settings.h"

#include <algorithm>
#include <cmath>
#include <string>

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
  settings.render.cache.choose_device = false;  // runs of other frames have to agree
  settings.render.cache.cache_out.clear();
  settings.frames.range = FrameList{{{frame, frame}}};
  settings.render.camera = camera_of_frame(whole, frame);
  if (whole.exposure) settings.image.display.exposure = *whole.exposure;
  for (std::string& output : settings.outputs) output = name_of_frame(output, frame);
  settings.stats = name_of_frame(settings.stats, frame);
  return settings;
}

int last_frame_of_animation(const RenderSettings& settings, const scene::Scene& scene) {
  if (settings.frames.turntable > 0) return settings.frames.turntable - 1;
  const std::string& chosen = settings.load.animation;
  double seconds = 0.0;
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    const scene::Animation& animation = scene.animations[i];
    if (chosen.empty() || chosen == animation.name || chosen == std::to_string(i))
      seconds = std::max(seconds, animation.seconds);
  }
  constexpr double kMax = 1e7, kRounding = 1e-4;
  return static_cast<int>(std::min(seconds * settings.frames.fps + kRounding, kMax));
}

std::vector<int> sampled_frames(int last) {
  constexpr int kSteps = 7;
  const int steps = std::min(last, kSteps);
  std::vector<int> frames = {0};
  for (int k = 1; k <= steps; ++k) frames.push_back(k * last / steps);
  return frames;
}

std::vector<int> sampled_frames(const std::vector<int>& frames) {
  std::vector<int> sampled;
  for (const int place : sampled_frames(static_cast<int>(frames.size()) - 1))
    sampled.push_back(frames[static_cast<std::size_t>(place)]);
  return sampled;
}

std::vector<int> frames_of_motion(const RenderSettings& settings, int frame) {
  std::vector<int> frames;
  if (renderer::has(settings.render.aovs, renderer::Aov::motion)) frames.push_back(frame - 1);
  if (renderer::has(settings.render.aovs, renderer::Aov::motion_next)) frames.push_back(frame + 1);
  return frames;
}

}  // namespace gatelight::apps
