#include "bench/world_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "renderer/film/camera.h"
#include "renderer/film/camera_choice.h"
#include "scene/gltf.h"

namespace gatelight::bench {

namespace {

std::unique_ptr<WorldFixture> load(const SceneCase& which) {
  const std::filesystem::path file = file_of(which);
  if (file.empty()) return nullptr;
  auto w = std::make_unique<WorldFixture>();
  w->scene = scene::load_gltf(file);
  if (!which.sun) {
    std::erase_if(w->scene.lights, [](const scene::PunctualLight& light) {
      return light.type == scene::LightType::directional;
    });
  }
  w->options.width = kWidth;
  w->options.height = kHeight;
  w->options.max_depth = kMaxDepth;
  w->options.camera.name = which.camera;
  w->options.environment.constant = which.sky;
  w->requirements = scene::compute_requirements(w->scene);
  w->textures = std::make_unique<renderer::Textures>(w->scene);
  w->environment = std::make_unique<renderer::Environment>(w->options.environment);
  w->coverage = std::make_unique<renderer::Coverage>(w->scene, *w->textures);
  w->surfaces = std::make_unique<renderer::Surfaces>(w->scene, *w->textures);
  w->accel = std::make_unique<renderer::Accel>(w->scene, *w->coverage, renderer::AccelOptions{});
  w->lights =
      std::make_unique<renderer::Lights>(w->scene, *w->textures, *w->environment, w->options.light_selection);
  w->world = std::make_unique<renderer::World>(renderer::World{
      w->scene, w->requirements, *w->textures, *w->surfaces, *w->accel, *w->environment, *w->lights});
  const float aspect = static_cast<float>(kWidth) / static_cast<float>(kHeight);
  w->camera = std::make_unique<renderer::Camera>(renderer::choose_camera(w->scene, w->options.camera, aspect),
                                                 kWidth, kHeight);
  return w;
}

}  // namespace

std::vector<std::vector<renderer::CameraSample>> WorldFixture::tiles(std::uint32_t sample) const {
  constexpr int kTile = 16;
  std::vector<std::vector<renderer::CameraSample>> result;
  for (int ty = 0; ty < kHeight; ty += kTile) {
    for (int tx = 0; tx < kWidth; tx += kTile) {
      std::vector<renderer::CameraSample>& tile = result.emplace_back();
      for (int y = ty; y < std::min(ty + kTile, kHeight); ++y) {
        for (int x = tx; x < std::min(tx + kTile, kWidth); ++x) {
          renderer::CameraSample s;
          s.sampler = renderer::Sampler(options.sampler, 0, static_cast<std::uint32_t>(x),
                                        static_cast<std::uint32_t>(y), sample);
          s.seed = renderer::hash(static_cast<std::uint32_t>(y * kWidth + x) ^ renderer::hash(sample));
          const scene::Vec2 offset = s.sampler.get_2d(renderer::dimension::kFilm);
          s.camera_ray = camera->ray(static_cast<float>(x) + offset.x(), static_cast<float>(y) + offset.y());
          tile.push_back(s);
        }
      }
    }
  }
  return result;
}

const BareEmbree& WorldFixture::bare() const {
  if (!bare_) bare_ = std::make_unique<BareEmbree>(scene);
  return *bare_;
}

std::filesystem::path file_of(const SceneCase& which) {
  const char* folder = std::getenv("GATELIGHT_SCENES");
  if (!folder) return {};
  std::filesystem::path file = std::filesystem::path(folder) / which.file;
  return std::filesystem::exists(file) ? file : std::filesystem::path{};
}

const WorldFixture* world(const SceneCase& which) {
  static std::map<std::string, std::unique_ptr<WorldFixture>> cache;
  auto [found, inserted] = cache.try_emplace(which.name);
  if (inserted) found->second = load(which);
  return found->second.get();
}

}  // namespace gatelight::bench
