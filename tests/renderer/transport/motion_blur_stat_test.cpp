// A picture with an open shutter is the mean of still pictures at many times in it.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "scene/gltf.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

constexpr int kWidth = 32, kHeight = 18, kBlock = 3;  // pixels
constexpr int kTimes = 32;
constexpr int kSeeds = 16, kSamplesOfATime = 2;
constexpr double kMiddle = 0.6, kOpen = 0.5;  // seconds
const double kFamily = 1e-4;

RenderOptions options_of(int spp, const std::string& animation) {
  RenderOptions options;
  options.aovs = {Aov::albedo};
  if (animation == "camera") options.camera.name = "walk-camera";
  if (animation == "flag")
    options.camera.look_at = LookAt{Vec3(-1.8f, 1.7f, -0.4f), Vec3(-2.4f, 1.7f, -1.6f)};
  options.width = kWidth;
  options.height = kHeight;
  options.spp = spp;
  options.filter = PixelFilter::box;
  options.max_depth = 2;
  options.denoise.denoiser = DenoiserKind::none;
  return options;
}

/// The mean of all channels of a block of pixels.
double mean_of_block(const Layer& layer, int x0, int y0) {
  const auto channels = static_cast<int>(layer.channels.size());
  double sum = 0.0;
  int count = 0;
  for (int y = y0; y < std::min(y0 + kBlock, kHeight); ++y) {
    for (int x = x0; x < std::min(x0 + kBlock, kWidth); ++x) {
      for (int c = 0; c < channels; ++c, ++count)
        sum += static_cast<double>(layer.values[static_cast<std::size_t>((y * kWidth + x) * channels + c)]);
    }
  }
  return sum / count;
}

std::vector<double> means_of_blocks(const Picture& picture, const std::string& layer) {
  const auto found = std::find_if(picture.layers.begin(), picture.layers.end(),
                                  [&](const Layer& l) { return l.name == layer; });

  std::vector<double> means;
  for (int y = 0; y < kHeight; y += kBlock) {
    for (int x = 0; x < kWidth; x += kBlock) means.push_back(mean_of_block(*found, x, y));
  }
  return means;
}

/// The means of blocks of each layer, with several seeds.
struct Blocks {
  std::map<std::string, std::vector<std::vector<double>>> of_layer;

  void add(const std::string& layer, int seed, const std::vector<double>& means, double weight) {
    std::vector<std::vector<double>>& of_seed = of_layer[layer];
    of_seed.resize(kSeeds);
    std::vector<double>& sum = of_seed[static_cast<std::size_t>(seed)];
    sum.resize(means.size());
    for (std::size_t i = 0; i < means.size(); ++i) sum[i] += weight * means[i];
  }
};

/// Pictures of one time, with several seeds.
void add_pictures(const std::string& path, const scene::LoadOptions& load, int spp,
                  const std::vector<std::string>& layers, int first_seed, double weight, Blocks& blocks) {
  const scene::Scene scene = scene::load_gltf(path, load);
  Renderer renderer(scene, options_of(spp, load.animation));
  renderer.begin_frames(*load.time);
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Picture picture = renderer.render_frame(first_seed + seed);
    for (const std::string& layer : layers) blocks.add(layer, seed, means_of_blocks(picture, layer), weight);
  }
}

/// The number of blocks whose means differ, at a significance for all of them together.
int count_different(const Blocks& a, const Blocks& b, const std::string& layer) {
  const auto &of_a = a.of_layer.at(layer), &of_b = b.of_layer.at(layer);
  const std::size_t count = of_a[0].size();
  int different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    testing::Moments difference;
    for (std::size_t s = 0; s < kSeeds; ++s) difference.add(of_a[s][i] - of_b[s][i]);
    different += testing::mean_p_value(difference, 0.0) < testing::sidak(kFamily, count) ? 1 : 0;
  }
  return different;
}

struct Case {
  const char* animation;
  std::vector<std::string> layers;  ///< albedo has less noise than light
};

class MotionBlur : public ::testing::TestWithParam<Case> {};

void PrintTo(const Case& each, std::ostream* out) {
  *out << each.animation;
}

TEST_P(MotionBlur, IsTheMeanOfStillTimes) {
  const std::string path = GATELIGHT_DATA "/moving-room.glb";
  const auto& [animation, layers] = GetParam();
  Blocks blurred, stills, middle;
  add_pictures(path, {.time = kMiddle, .shutter = kOpen, .animation = animation}, kSamplesOfATime * kTimes,
               layers, 0, 1.0, blurred);
  add_pictures(path, {.time = kMiddle, .animation = animation}, kTimes, layers, 500, 1.0, middle);
  for (int k = 0; k < kTimes; ++k) {
    const double time = kMiddle + kOpen * ((k + 0.5) / kTimes - 0.5);
    add_pictures(path, {.time = time, .animation = animation}, kSamplesOfATime, layers, 1000 + k * kSeeds,
                 1.0 / kTimes, stills);
  }
  for (const std::string& layer : layers) {
    EXPECT_EQ(count_different(blurred, stills, layer), 0) << layer;
    EXPECT_GT(count_different(middle, stills, layer), 0) << "the test would miss a closed shutter";
  }
}

INSTANTIATE_TEST_SUITE_P(Animations, MotionBlur,
                         ::testing::Values(Case{"lamp", {"", "albedo"}}, Case{"mirror", {""}},
                                           Case{"walk", {"albedo"}}, Case{"flag", {"albedo"}},
                                           Case{"door", {"albedo"}}, Case{"camera", {"albedo"}}),
                         [](const auto& each) { return std::string(each.param.animation); });

TEST(MotionBlur, StillScenesKeepTheirBits) {
  const std::string path = GATELIGHT_DATA "/moving-room.glb";
  const auto picture = [&](const std::string& animation, double shutter) {
    const scene::Scene scene =
        scene::load_gltf(path, {.time = kMiddle, .shutter = shutter, .animation = animation});
    return Renderer(scene, options_of(4, animation)).render().layers[0].values;
  };
  EXPECT_EQ(picture("lamp-off", 0.1), picture("lamp-off", 0.0)) << "materials stand still in a shutter";
  EXPECT_NE(picture("lamp", 0.1), picture("lamp", 0.0));
}

}  // namespace
}  // namespace gatelight::renderer
