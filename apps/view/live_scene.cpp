#include "apps/view/live_scene.h"

#include <tuple>
#include <utility>

namespace gatelight::apps {
namespace {

/// The file's own scene, at a time: it can then be changed.
scene::LoadOptions options_of_loading(scene::LoadOptions options) {
  options.time = options.time.value_or(0.0);
  options.lights.clear();
  options.visibility.clear();
  options.light_links.clear();
  return options;
}

}  // namespace

SceneChanges changes_of(const scene::LoadOptions& options) {
  return {options.lights, options.visibility, options.light_links};
}

LiveScene::LiveScene(const std::string& path, const scene::LoadOptions& options)
    : file_(path, options_of_loading(options)), scene_(file_.load()), seconds_(options.time.value_or(0.0)) {
  // Lights change between pictures, and with them the tables of light sampling.
  scene_.motion.lights = true;
  keep();
  show(seconds_, changes_of(options));
}

bool LiveScene::show(double seconds, const SceneChanges& changes) {
  const bool moves = seconds != seconds_ && !scene_.animations.empty();
  if (!moves && changes == changes_) return false;
  restore();
  if (moves) {
    file_.show(scene_, seconds);
    keep();
  }
  seconds_ = seconds;
  try {
    apply(changes);
    changes_ = changes;
  } catch (...) {
    restore();
    apply(changes_);
    throw;
  }
  return true;
}

void LiveScene::keep() {
  originals_ = {.environment_rays = scene_.environment_rays,
                .environment_link = scene_.environment_link,
                .object_sets = scene_.object_sets};
  for (const scene::PunctualLight& light : scene_.lights) {
    originals_.intensities.push_back(light.intensity);
    originals_.lights.emplace_back(light.rays, light.link);
  }
  for (const scene::Material& material : scene_.materials) originals_.emissions.push_back(material.emission);
  for (const scene::Instance& instance : scene_.instances)
    originals_.instances.emplace_back(instance.visibility, instance.link);
}

void LiveScene::restore() {
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    scene_.lights[i].intensity = originals_.intensities[i];
    std::tie(scene_.lights[i].rays, scene_.lights[i].link) = originals_.lights[i];
  }
  for (std::size_t i = 0; i < scene_.materials.size(); ++i)
    scene_.materials[i].emission = originals_.emissions[i];
  for (std::size_t i = 0; i < scene_.instances.size(); ++i)
    std::tie(scene_.instances[i].visibility, scene_.instances[i].link) = originals_.instances[i];
  scene_.environment_rays = originals_.environment_rays;
  scene_.environment_link = originals_.environment_link;
  scene_.object_sets = originals_.object_sets;
  scene_.dark_lights.clear();
}

void LiveScene::apply(const SceneChanges& changes) {
  adjust_lights(scene_, changes.lights);
  apply_visibility(scene_, changes.visibility);
  link_lights(scene_, changes.light_links);
}

}  // namespace gatelight::apps
