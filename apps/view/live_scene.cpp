#include "apps/view/live_scene.h"

#include <utility>

namespace gatelight::apps {
namespace {

/// The file's own lights, at a time: the scene can then show others.
scene::LoadOptions options_of_loading(scene::LoadOptions options) {
  options.time = options.time.value_or(0.0);
  options.lights.clear();
  return options;
}

}  // namespace

LiveScene::LiveScene(const std::string& path, const scene::LoadOptions& options)
    : file_(path, options_of_loading(options)), scene_(file_.load()), seconds_(options.time.value_or(0.0)) {
  // Lights change between pictures, and with them the tables of light sampling.
  scene_.motion.lights = true;
  keep_lights();
  show(seconds_, options.lights);
}

bool LiveScene::show(double seconds, const std::vector<scene::LightAdjustment>& lights) {
  const bool moves = seconds != seconds_ && !scene_.animations.empty();
  if (!moves && lights == lights_) return false;
  restore_lights();
  if (moves) {
    file_.show(scene_, seconds);
    keep_lights();
  }
  seconds_ = seconds;
  try {
    adjust_lights(scene_, lights);
    lights_ = lights;
  } catch (...) {
    restore_lights();
    adjust_lights(scene_, lights_);
    throw;
  }
  return true;
}

void LiveScene::keep_lights() {
  intensities_.clear();
  emissions_.clear();
  for (const scene::PunctualLight& light : scene_.lights) intensities_.push_back(light.intensity);
  for (const scene::Material& material : scene_.materials) emissions_.push_back(material.emission);
}

void LiveScene::restore_lights() {
  for (std::size_t i = 0; i < intensities_.size(); ++i) scene_.lights[i].intensity = intensities_[i];
  for (std::size_t i = 0; i < emissions_.size(); ++i) scene_.materials[i].emission = emissions_[i];
  scene_.dark_lights.clear();
}

}  // namespace gatelight::apps
