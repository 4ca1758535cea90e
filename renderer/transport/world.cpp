#include "renderer/transport/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>

#include "base/errors.h"
#include "scene/light_names.h"

namespace gatelight::renderer {
namespace {

/// Names of the objects, each once, in order; at most kMaxNames.
std::vector<std::string> names_of(const scene::Scene& scene) {
  constexpr std::size_t kMaxNames = 20;
  std::vector<std::string> names;
  for (const scene::Instance& instance : scene.instances) {
    if (std::find(names.begin(), names.end(), instance.name) != names.end()) continue;
    names.push_back(names.size() < kMaxNames ? instance.name : "...");
    if (names.size() > kMaxNames) break;
  }
  return names;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// The value of World::catchers.
std::vector<std::uint8_t> find_catchers(const scene::Scene& scene, const BackgroundOptions& background) {
  const std::vector<std::string> nodes = split(background.shadow_catcher, ';');
  if (!background.is_separate()) {
    if (nodes.empty()) return {};
    throw BadOption({"shadow-catcher", nodes.front(), "needs a picture with alpha",
                     "`background` transparent, r,g,b or FILE"});
  }
  std::vector<std::uint8_t> catchers;
  std::vector<bool> used(nodes.size(), false);
  for (const scene::Instance& instance : scene.instances) {
    bool catches = instance.visibility.shadow_catcher;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!scene::fits_light_name(nodes[n], instance.name)) continue;
      used[n] = catches = true;
    }
    catchers.push_back(catches ? 1 : 0);
  }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) {
    throw BadOption({"shadow-catcher", nodes[static_cast<std::size_t>(unused - used.begin())],
                     fmt::format("is not an object of {}", scene.path),
                     fmt::format("one of '{}'", fmt::join(names_of(scene), "', '"))});
  }
  if (std::find(catchers.begin(), catchers.end(), 1) == catchers.end()) return {};
  return catchers;
}

/// The value of World::warning.
std::string catcher_warning(const scene::Scene& scene, const BackgroundOptions& background) {
  if (background.is_separate()) return "";
  for (const scene::Instance& instance : scene.instances) {
    if (instance.visibility.shadow_catcher)
      return fmt::format(
          "{}: '{}' is shown itself, because shadow catchers need `background` transparent, r,g,b or FILE",
          scene.path, instance.name);
  }
  return "";
}

/// Those that are built before the coverage.
ReusableParts reusable_parts(const scene::Scene& scene, const WorldOptions& options, ReusableParts parts) {
  if (!parts.textures || scene.motion.materials) parts.textures = std::make_shared<const Textures>(scene);
  if (!parts.environment || scene.motion.image_light)
    parts.environment = std::make_shared<const Environment>(
        options.environment, scene.image_light ? &*scene.image_light : nullptr);
  return parts;
}

const Accel& updated(std::shared_ptr<Accel>& accel, const scene::Scene& scene, const Coverage& coverage,
                     const RayMasks& masks, const AccelOptions& options) {
  if (accel) {
    accel->update(scene, coverage, masks);
  } else {
    accel = std::make_shared<Accel>(scene, coverage, masks, options);
  }
  return *accel;
}

/// Where shadow rays and bounces see different objects, one of the two finds a constant sky: bounces, as in
/// Cycles, unless lights have blockers of their own.
std::optional<bool> sampled_sky(const RayMasks& masks) {
  if (masks.any_blockers()) return true;
  return masks.shadows_differ() ? std::optional(false) : std::nullopt;
}

/// Fog fills the bounds of the scene and of its lamps, and a little more, so that their surfaces are inside.
std::optional<ScatteringMedium> fog_of(const scene::Scene& scene, const std::optional<FogOptions>& fog) {
  Box box = scene.bounds;
  for (const scene::PunctualLight& light : scene.lights) {
    if (light.type != scene::LightType::directional) box.extend(light.position);
  }
  if (!fog || box.isEmpty()) return {};
  const Vec3 margin = Vec3::Constant(1e-3f * box.diagonal().norm());
  return ScatteringMedium{.extinction = Color::Constant(fog->density),
                          .albedo = fog->albedo,
                          .anisotropy = fog->anisotropy,
                          .scatters = true,
                          .color = fog->albedo,
                          .sampled = true,
                          .box = Box(box.min() - margin, box.max() + margin)};
}

}  // namespace

World::World(const scene::Scene& scene_in, const WorldOptions& options, const ReusableParts& earlier)
    : scene(scene_in),
      requirements(scene::compute_requirements(scene)),
      lasting(reusable_parts(scene, options, earlier)),
      textures(*lasting.textures),
      media(scene, requirements.nested_volumes, options.glass_shadows == GlassShadows::straight,
            fog_of(scene, options.environment.fog)),
      environment(*lasting.environment),
      coverage(scene, textures, media, options.glass_shadows == GlassShadows::straight),
      surfaces(scene, textures),
      catchers(find_catchers(scene, options.background)),
      masks(scene, catchers),
      accel(updated(lasting.accel, scene, coverage, masks, options.acceleration)),
      lights(scene, textures, environment, options.light_selection, sampled_sky(masks)),
      light_rules(scene, lights, masks),
      light_arrays(lights),
      kernels(choose_shading_kernels(options.acceleration.isa)),
      light_groups(options.light_groups, scene, lights),
      any_holdout(std::any_of(scene.instances.begin(), scene.instances.end(),
                              [](const auto& instance) { return instance.visibility.holdout; })),
      separate_background(options.background.is_separate()),
      warning(catcher_warning(scene, options.background)) {}

bool World::is_dark() const {
  return lights.empty() &&
         std::none_of(scene.instances.begin(), scene.instances.end(), [&](const scene::Instance& instance) {
           return !instance.hidden && scene.material_of(instance).unlit;
         });
}

}  // namespace gatelight::renderer
