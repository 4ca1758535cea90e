// A group's layer is the picture in which only its lights are on.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "renderer/render.h"
#include "tests/support/grouped_lights.h"
#include "tests/support/light_scenes.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;

constexpr int kGroupSeeds = 16;
constexpr std::size_t kBlocks = 6;

/// The mean luminance of blocks of 16x16 pixels of a picture, for each seed.
using GroupBlocks = std::array<Moments, kBlocks>;

void add(const std::vector<float>& values, GroupBlocks& blocks) {
  std::array<double, kBlocks> sums{};
  for (std::size_t p = 0; p < values.size() / 3; ++p) {
    const std::size_t x = p % 48, y = p / 48;
    sums[x / 16 + 3 * (y / 16)] +=
        static_cast<double>(luminance(Color(values[3 * p], values[3 * p + 1], values[3 * p + 2])));
  }
  for (std::size_t b = 0; b < kBlocks; ++b) blocks[b].add(sums[b] / 256.0);
}

double welch_p_value(const Moments& a, const Moments& b) {
  const double va = a.variance() / static_cast<double>(a.count());
  const double vb = b.variance() / static_cast<double>(b.count());
  const double difference = a.mean() - b.mean();
  if (va + vb == 0.0) return difference == 0.0 ? 1.0 : 0.0;
  const double freedom =
      (va + vb) * (va + vb) /
      (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return testing::student_two_sided(difference / std::sqrt(va + vb), freedom);
}

/// The scene with only the lights of one group.
scene::Scene only(const std::string& group) {
  scene::Scene scene = testing::lit_by_all();
  for (scene::PunctualLight& light : scene.lights) {
    if (light.name != group) light.intensity.setZero();
  }
  for (scene::Material& material : scene.materials) {
    if (material.name != (group == "rest" ? "glow" : group)) material.emission.setZero();
  }
  return scene;
}

TEST(LightGroupsStat, ALayerIsThePictureOfOnlyItsLights) {
  const tests::TemporaryFolder folder;
  const scene::Scene all = testing::lit_by_all();
  RenderOptions options = testing::view_of_all();
  options.environment = testing::uniform_picture(folder, 0.2f);
  options.clamp = 0.0f;
  const std::vector<std::string> names = {"bulb", "torch", "noon", "panel", "sky", "rest"};
  std::vector<GroupBlocks> layers(names.size()), alone(names.size());
  for (int seed = 0; seed < kGroupSeeds; ++seed) {
    options.seed = static_cast<std::uint32_t>(seed);
    const Picture picture = Renderer(all, options).render();
    for (std::size_t g = 0; g < names.size(); ++g) add(picture.find("light-" + names[g])->values, layers[g]);
  }
  options.light_groups.clear();
  const EnvironmentOptions sky = options.environment;
  const double significance = testing::sidak(1e-4, names.size() * kBlocks);
  for (std::size_t g = 0; g < names.size(); ++g) {
    options.environment = names[g] == "sky" ? sky : EnvironmentOptions{};
    const scene::Scene scene = only(names[g]);
    for (int seed = 0; seed < kGroupSeeds; ++seed) {
      options.seed = static_cast<std::uint32_t>(1000 + seed);
      add(Renderer(scene, options).render().layers.front().values, alone[g]);
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      EXPECT_GT(welch_p_value(layers[g][b], alone[g][b]), significance)
          << names[g] << ", block " << b << ": " << layers[g][b].mean() << " instead of "
          << alone[g][b].mean();
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
