#include "tests/renderer/golden/golden_cases.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "renderer/image/image_write.h"
#include "renderer/render.h"
#include "scene/gltf.h"

namespace gatelight::testing {
namespace {

using renderer::Integrator;
using renderer::RenderOptions;

std::filesystem::path scene_file(const GoldenCase& c) {
  return std::filesystem::path(GATELIGHT_SOURCE_DIR) / "data" / (c.scene + ".glb");
}

/// A sky with a broad sun and a brown ground, written where tests may write. It has no texel that is much
/// brighter than its neighbours, so that glass makes no rare bright samples.
std::filesystem::path write_sky() {
  constexpr int kWidth = 128;
  constexpr int kHeight = 64;
  renderer::Picture picture;
  picture.width = kWidth;
  picture.height = kHeight;
  renderer::Layer layer;
  layer.channels = {"R", "G", "B"};
  const Vec3 sun = Vec3(-0.5f, 0.6f, 0.62f).normalized();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float theta = kPi * (static_cast<float>(y) + 0.5f) / kHeight;
      const float phi = 2.0f * kPi * ((static_cast<float>(x) + 0.5f) / kWidth - 0.5f);
      const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
      Color sky(0.20f, 0.16f, 0.12f);
      if (d.y() > 0.0f) sky = Color(0.35f, 0.45f, 0.60f) + (0.3f - 0.3f * d.y());
      const float near = std::max(0.0f, d.dot(sun));
      sky += Color(6.0f, 5.0f, 3.5f) * std::exp(-40.0f * (1.0f - near));
      layer.values.insert(layer.values.end(), {sky.x(), sky.y(), sky.z()});
    }
  }
  picture.layers.push_back(std::move(layer));
  const std::filesystem::path folder = std::filesystem::path(GATELIGHT_BINARY_DIR) / "golden";
  std::filesystem::create_directories(folder);
  // Tests run side by side, and each reads its own.
  const std::filesystem::path file = folder / ("sky-" + std::to_string(::getpid()) + ".exr");
  renderer::write_image(picture, file, {.exr_float = true});
  return file;
}

}  // namespace

std::vector<GoldenCase> golden_cases() {
  std::vector<GoldenCase> cases;
  const auto add = [&](std::string name, std::string scene, int width, int height,
                       int spp) -> RenderOptions& {
    GoldenCase c;
    c.name = std::move(name);
    c.scene = std::move(scene);
    c.options.width = width;
    c.options.height = height;
    c.options.spp = spp;
    c.options.max_depth = 8;  // longer paths cost more samples of the reference than they show
    c.options.seed = 20251;
    c.options.sampler = renderer::SamplerKind::independent;
    c.options.aovs = {renderer::Aov::variance};
    return cases.emplace_back(std::move(c)).options;
  };
  add("cornell-box", "cornell-box", 48, 48, 128);
  add("furnace", "furnace", 32, 32, 64);
  add("living-room", "living-room", 80, 45, 128);
  add("teapot", "teapot-stadium", 64, 36, 64).camera.name = "teapot";
  add("hall", "teapot-stadium", 64, 36, 64).camera.name = "hall";
  add("material-grid", "material-grid", 80, 45, 128);
  cases.back().sky = true;
  add("turntable", "turntable", 96, 54, 128).environment.automatic = true;
  {
    RenderOptions& prism = add("turntable-prism", "turntable", 48, 48, 256);
    prism.environment.automatic = true;
    prism.camera.look_at = renderer::LookAt{{1.5f, 0.5f, 1.9f}, {0.95f, 0.2f, 0.55f}, {0, 1, 0}};
    prism.camera.fov_degrees = 22.0f;
  }
  add("iced-water", "iced-water", 64, 64, 256);
  add("cornell-box-ao", "cornell-box", 48, 48, 512).integrator = Integrator::ao;
  add("living-room-ao", "living-room", 64, 36, 256).integrator = Integrator::ao;
  add("teapot-ao", "teapot-stadium", 64, 36, 512).camera.name = "teapot";
  cases.back().options.integrator = Integrator::ao;
  cases.back().options.ao_distance = 0.15f;
  return cases;
}

const GoldenCase& golden_case(const std::string& name) {
  static const std::vector<GoldenCase> cases = golden_cases();
  const auto found =
      std::find_if(cases.begin(), cases.end(), [&](const GoldenCase& c) { return c.name == name; });
  if (found == cases.end()) throw std::out_of_range("no golden picture is called " + name);
  return *found;
}

std::filesystem::path golden_reference(const GoldenCase& c) {
  return std::filesystem::path(GATELIGHT_SOURCE_DIR) / "tests" / "golden" / (c.name + ".exr");
}

scene::Scene load_golden_scene(const GoldenCase& c) {
  return scene::load_gltf(scene_file(c));
}

std::string golden_fingerprint(const GoldenCase& c) {
  std::ifstream file(scene_file(c), std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + scene_file(c).string());
  // FNV-1a, 64 bits.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::istreambuf_iterator<char> i(file), end; i != end; ++i) {
    hash = (hash ^ static_cast<unsigned char>(*i)) * 0x100000001b3u;
  }
  return std::to_string(hash);
}

renderer::Picture render_golden(const GoldenCase& c, const scene::Scene& scene, RenderOptions options) {
  std::filesystem::path sky;
  if (c.sky) {
    sky = write_sky();
    options.environment.file = sky.string();
  }
  renderer::Renderer renderer(scene, options);
  if (c.sky) std::filesystem::remove(sky);
  return renderer.render();
}

}  // namespace gatelight::testing
