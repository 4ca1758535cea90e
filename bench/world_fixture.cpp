#include "bench/world_fixture.h"

#include <cstdlib>
#include <map>

#include "renderer/film/camera_choice.h"
#include "renderer/film/film_samples.h"
#include "scene/gltf.h"

namespace gatelight::bench {

namespace {

renderer::RenderOptions options_of(const SceneCase& which) {
  renderer::RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.max_depth = kMaxDepth;
  options.camera.name = which.camera;
  options.environment.constant = which.sky;
  return options;
}

}  // namespace

WorldFixture::WorldFixture(const SceneCase& which)
    : scene(scene::load_gltf(file_of(which))),
      options(options_of(which)),
      world(scene, {.environment = options.environment, .light_selection = options.light_selection}) {}

std::vector<std::vector<renderer::CameraSample>> WorldFixture::tiles(std::uint32_t sample) const {
  const renderer::Camera camera(
      renderer::choose_camera(scene, options.camera,
                              static_cast<float>(kWidth) / static_cast<float>(kHeight)),
      kWidth, kHeight);
  const renderer::FilterSampler filter(options.filter, options.filter_width);
  const renderer::TileGrid grid({0, 0, kWidth, kHeight});
  std::vector<std::vector<renderer::CameraSample>> result(static_cast<std::size_t>(grid.count()));
  std::vector<renderer::Pixel> pixels;
  for (int tile = 0; tile < grid.count(); ++tile) {
    grid.pixels(tile, pixels);
    for (const renderer::Pixel& pixel : pixels)
      result[static_cast<std::size_t>(tile)].push_back(
          renderer::make_camera_sample({pixel, sample}, options, camera, filter));
  }
  return result;
}

const BareEmbree& WorldFixture::bare(Watertight watertight) const {
  std::unique_ptr<BareEmbree>& bare = bare_[static_cast<std::size_t>(watertight)];
  if (!bare) bare = std::make_unique<BareEmbree>(scene, watertight);
  return *bare;
}

std::filesystem::path file_of(const SceneCase& which) {
  const char* folder = std::getenv("GATELIGHT_SCENES");
  const std::filesystem::path own = which.file;
  if (!folder && own.is_relative()) return {};
  std::filesystem::path file = own.is_absolute() ? own : folder / own;
  return std::filesystem::exists(file) ? file : std::filesystem::path{};
}

const WorldFixture* world(const SceneCase& which) {
  static std::map<std::string, std::unique_ptr<WorldFixture>> cache;
  auto [found, inserted] = cache.try_emplace(which.name);
  if (inserted && !file_of(which).empty()) found->second = std::make_unique<WorldFixture>(which);
  return found->second.get();
}

}  // namespace gatelight::bench
