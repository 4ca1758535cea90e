#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/image/cryptomatte.h"
#include "renderer/render.h"
#include "scene/shutter.h"
#include "tests/support/denoiser.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

constexpr int kSize = 16;

/// One metre is a pixel; (0, 0, 0) is the middle of the picture.
RenderOptions options_for(std::vector<MatteKind> kinds = {MatteKind::object, MatteKind::material}) {
  RenderOptions options;
  options.width = options.height = kSize;
  options.spp = 1;
  options.filter = PixelFilter::box;
  options.camera.look_at = LookAt{{0, 0, 10}, {0, 0, 0}, {0, 1, 0}};
  options.camera.projection = Projection::orthographic;
  options.camera.view_height = static_cast<float>(kSize);
  options.environment.constant = Color::Constant(1.0f);
  options.cryptomattes = std::move(kinds);
  options.cache.train_steps = 2;
  options.cache.batch = 256;
  return options;
}

Picture rendered(const scene::Scene& scene, const RenderOptions& options) {
  return Renderer(scene, options).render();
}

/// The id and coverage of a rank.
IdCoverage at(const Picture& picture, const std::string& kind, std::size_t pixel, std::size_t rank) {
  const Layer* layer = picture.find(kind + "0" + std::to_string(rank / 2));
  const float* values = &layer->values.at(4 * pixel + 2 * (rank % 2));
  return {std::bit_cast<std::uint32_t>(values[0]), values[1]};
}

/// The mask of a name, as compositing makes it.
float mask(const Picture& picture, const std::string& kind, std::size_t pixel, const std::string& name) {
  float sum = 0.0f;
  for (std::size_t rank = 0; rank < kCryptomatteRanks; ++rank) {
    const IdCoverage found = at(picture, kind, pixel, rank);
    if (found.id == cryptomatte_id(name)) sum += found.coverage;
  }
  return sum;
}

float all(const Picture& picture, const std::string& kind, std::size_t pixel) {
  float sum = 0.0f;
  for (std::size_t rank = 0; rank < kCryptomatteRanks; ++rank) sum += at(picture, kind, pixel, rank).coverage;
  return sum;
}

std::size_t pixel_at(int x, int y) {
  return static_cast<std::size_t>(y * kSize + x);
}

/// An upright rectangle with a name, in the plane of that depth.
void add_rectangle(SceneBuilder& builder, const std::string& name, int material, float x0, float y0, float x1,
                   float y1, float z = 0.0f) {
  builder.quad(material, Vec3(x0, y0, z), Vec3(x1 - x0, 0, 0), Vec3(0, y1 - y0, 0));
  builder.scene().instances.back().name = name;
}

int matte(SceneBuilder& builder, const std::string& name, float alpha = 1.0f) {
  scene::Material material = SceneBuilder::lambert(Color::Constant(0.5f));
  material.name = name;
  material.base_alpha = alpha;
  if (alpha < 1.0f) material.alpha_mode = scene::AlphaMode::blend;
  return builder.material(material);
}

/// Two rectangles whose edges lie at quarters and halves of a pixel, the second one partly behind the first.
SceneBuilder two_rectangles() {
  SceneBuilder builder;
  const int clay = matte(builder, "clay");
  add_rectangle(builder, "left", clay, -4.25f, -4, 0.5f, 4);
  add_rectangle(builder, "right", clay, 0, -4, 5.75f, 3.5f, -1);
  return builder;
}

TEST(CryptomattePass, CoverageIsTheAreaInThePixel) {
  SceneBuilder builder = two_rectangles();
  const Picture picture = rendered(builder.scene(), options_for());
  // Points of a pixel are a (0, 5, 2)-net: halves and quarters hold as many as their area says.
  const auto expect = [&](int x, int y, float left, float right) {
    const std::size_t p = pixel_at(x, y);
    EXPECT_EQ(mask(picture, "CryptoObject", p, "left"), left) << x << "," << y;
    EXPECT_EQ(mask(picture, "CryptoObject", p, "right"), right) << x << "," << y;
    EXPECT_EQ(mask(picture, "CryptoMaterial", p, "clay"), left + right) << x << "," << y;
    EXPECT_EQ(all(picture, "CryptoObject", p), left + right) << "no other id";
  };
  expect(3, 8, 0.25f, 0);
  expect(4, 8, 1, 0);
  expect(8, 8, 0.5f, 0.5f);
  expect(9, 8, 0, 1);
  expect(13, 8, 0, 0.75f);
  expect(9, 4, 0, 0.5f);
  expect(8, 4, 0.5f, 0.25f);
  expect(13, 4, 0, 0.375f);
  expect(14, 8, 0, 0);
  EXPECT_EQ(at(picture, "CryptoObject", pixel_at(14, 8), 0).id, 0u) << "the background has the id 0";
}

TEST(CryptomattePass, CoversThePathOfAnObjectWhileTheShutterIsOpen) {
  // Its left edge goes from x = 0 to x = 4, by half a metre from state to state.
  SceneBuilder builder;
  add_rectangle(builder, "moving", matte(builder, "clay"), 0, -4, 12, 4);
  scene::Instance& moving = builder.scene().instances.back();
  moving.baked = false;
  moving.moves = builder.scene().motion.instances = true;
  scene::ShutterMotion& shutter = builder.scene().shutter;
  shutter.is_open = shutter.instances = true;
  shutter.transforms.resize(1);
  shutter.vertices.resize(1);
  for (int key = 0; key < scene::kShutterKeys; ++key) {
    Affine state = Affine::Identity();
    state.translation() = Vec3(0.5f * static_cast<float>(key), 0, 0);
    shutter.transforms[0].push_back(state);
  }
  const Picture picture = rendered(builder.scene(), options_for({MatteKind::object}));
  const auto covered = [&](int x) { return mask(picture, "CryptoObject", pixel_at(x, 8), "moving"); };
  EXPECT_EQ(covered(7), 0.0f);
  for (int x = 8; x < 12; ++x) {
    const float middle = (static_cast<float>(x) - 7.5f) / 4.0f;
    EXPECT_NEAR(covered(x), middle, 0.1f) << x;
  }
  EXPECT_EQ(covered(13), 1.0f);
}

TEST(CryptomattePass, CoverageAddsUpToTheAlphaOfThePicture) {
  SceneBuilder builder = two_rectangles();
  add_rectangle(builder, "sheet", matte(builder, "sheet", 0.3f), -8, -8, 8, -2, 1);
  RenderOptions options = options_for();
  options.filter = PixelFilter::blackman_harris;
  options.camera.projection = Projection::perspective;
  options.camera.view_height.reset();
  options.camera.fov_degrees = 70.0f;
  options.camera.lens = {.aperture = 0.5f, .focus = "9"};
  options.background.kind = BackgroundOptions::Kind::transparent;
  options.spp = 32;
  options.aovs = {Aov::alpha};
  const Picture picture = rendered(builder.scene(), options);
  const Layer* alpha = picture.find("alpha");
  ASSERT_NE(alpha, nullptr);
  int partly = 0;
  for (std::size_t p = 0; p < alpha->values.size(); ++p) {
    EXPECT_NEAR(all(picture, "CryptoObject", p), alpha->values[p], 1e-6f) << p;
    EXPECT_NEAR(all(picture, "CryptoMaterial", p), alpha->values[p], 1e-6f) << p;
    partly += alpha->values[p] > 0.1f && alpha->values[p] < 0.9f ? 1 : 0;
  }
  EXPECT_GT(partly, 20);
}

TEST(CryptomattePass, BlendedSheetsShareThePixelWithWhatIsBehind) {
  SceneBuilder builder;
  add_rectangle(builder, "wall", matte(builder, "clay"), -8, -8, 8, 8);
  add_rectangle(builder, "sheet", matte(builder, "veil", 0.3f), -8, -8, 8, 8, 1);
  const Picture picture = rendered(builder.scene(), options_for());
  float sum = 0.0f;
  for (std::size_t p = 0; p < kSize * kSize; ++p) {
    const float sheet = mask(picture, "CryptoObject", p, "sheet");
    sum += sheet;
    // The two triangles of a sheet have random numbers of their own.
    EXPECT_NEAR(sheet, 0.3f, 0.16f);
    EXPECT_EQ(all(picture, "CryptoObject", p), 1.0f);
    EXPECT_EQ(at(picture, "CryptoObject", p, 0).id, cryptomatte_id("wall")) << "the greatest is first";
  }
  EXPECT_NEAR(sum / (kSize * kSize), 0.3f, 0.02f);
}

TEST(CryptomattePass, GlassIsAnObjectAndAShadowCatcherNothing) {
  SceneBuilder builder;
  const int clay = matte(builder, "clay");
  add_rectangle(builder, "floor", clay, -8, -8, 8, 8);
  add_rectangle(builder, "pane", builder.material(SceneBuilder::clear_glass()), -8, -8, 0, 8, 1);
  add_rectangle(builder, "behind", clay, -8, -8, 8, 8, -1);
  RenderOptions options = options_for();
  options.background = {.kind = BackgroundOptions::Kind::transparent,
                        .color = Color::Zero(),
                        .file = {},
                        .shadow_catcher = "floor"};
  const Picture picture = rendered(builder.scene(), options);
  EXPECT_EQ(mask(picture, "CryptoObject", pixel_at(4, 8), "pane"), 1.0f);
  EXPECT_EQ(mask(picture, "CryptoMaterial", pixel_at(4, 8), "material 1"), 1.0f) << "it has no name";
  EXPECT_EQ(all(picture, "CryptoObject", pixel_at(12, 8)), 0.0f);
}

TEST(CryptomattePass, SixOfManyNamesStayAndEqualOnesShareAnId) {
  SceneBuilder builder;
  const int clay = matte(builder, "clay");
  // Eight stripes in the pixel (8, 7): two of a quarter and four of a sixteenth with names of their own, and
  // two of an eighth with one name.
  const float widths[] = {4, 1, 2, 1, 1, 2, 1, 4};
  const char* names[] = {"a", "b", "twin", "c", "d", "twin", "e", "f"};
  float x = 0.0f;
  for (int i = 0; i < 8; ++i) {
    add_rectangle(builder, names[i], clay, x, 0, x + widths[i] / 16.0f, 1);
    x += widths[i] / 16.0f;
  }
  const std::size_t p = pixel_at(8, 7);
  const Picture picture = rendered(builder.scene(), options_for({MatteKind::object}));
  EXPECT_EQ(picture.find("CryptoMaterial00"), nullptr);
  std::vector<std::uint32_t> quarters, sixteenths;
  for (const char* name : {"a", "f", "twin"}) quarters.push_back(cryptomatte_id(name));
  for (const char* name : {"b", "c", "d", "e"}) sixteenths.push_back(cryptomatte_id(name));
  std::sort(quarters.begin(), quarters.end());
  std::sort(sixteenths.begin(), sixteenths.end());
  for (std::size_t rank = 0; rank < kCryptomatteRanks; ++rank) {
    const IdCoverage found = at(picture, "CryptoObject", p, rank);
    EXPECT_EQ(found.id, rank < 3 ? quarters[rank] : sixteenths[rank - 3]) << rank;
    EXPECT_EQ(found.coverage, rank < 3 ? 0.25f : 0.0625f) << rank;
  }
}

/// Only the Cryptomatte layers.
std::map<std::string, std::vector<float>> mattes_of(const Picture& picture) {
  std::map<std::string, std::vector<float>> mattes;
  for (const Layer& layer : picture.layers) {
    if (is_cryptomatte(picture, layer.name)) mattes[layer.name] = layer.values;
  }
  EXPECT_EQ(mattes.size(), 6u);
  return mattes;
}

TEST(CryptomattePass, DependsOnlyOnViewAndSeed) {
  SceneBuilder builder = two_rectangles();
  add_rectangle(builder, "sheet", matte(builder, "sheet", 0.3f), -8, -8, 8, -2, 1);
  RenderOptions options = options_for();
  options.filter = PixelFilter::blackman_harris;
  const auto mattes = mattes_of(rendered(builder.scene(), options));
  for (const int threads : {1, 3}) {
    for (const Integrator integrator : {Integrator::path, Integrator::ao, Integrator::nrc}) {
      RenderOptions other = options;
      other.threads = threads;
      other.integrator = integrator;
      other.spp = 5;
      if (threads == 3 && testing::missing_denoiser().empty()) testing::denoise(other);
      EXPECT_EQ(mattes_of(rendered(builder.scene(), other)), mattes) << static_cast<int>(integrator);
    }
  }
  options.seed = 1;
  EXPECT_NE(mattes_of(rendered(builder.scene(), options)), mattes);
}

TEST(CryptomattePass, APartOfThePictureIsAsInTheWhole) {
  SceneBuilder builder = two_rectangles();
  add_rectangle(builder, "sheet", matte(builder, "sheet", 0.3f), -8, -8, 8, -2, 1);
  RenderOptions options = options_for();
  options.width = 40;
  options.filter = PixelFilter::blackman_harris;
  const Picture whole = rendered(builder.scene(), options);
  options.region = {5, 3, 34, 16};
  const Picture part = rendered(builder.scene(), options);
  EXPECT_EQ(part.attributes, whole.attributes);
  for (const auto& [name, values] : mattes_of(part)) {
    for (int y = 3; y < 16; ++y) {
      for (int x = 5; x < 34; ++x) {
        for (int c = 0; c < 4; ++c) {
          EXPECT_EQ(values[static_cast<std::size_t>(((y - 3) * 29 + x - 5) * 4 + c)],
                    whole.find(name)->values[static_cast<std::size_t>((y * 40 + x) * 4 + c)]);
        }
      }
    }
  }
}

TEST(CryptomattePass, IsInEveryPictureOfASeriesAndASnapshot) {
  SceneBuilder builder = two_rectangles();
  RenderOptions options = options_for();
  options.spp = 3;
  Renderer renderer(builder.scene(), options);
  int snapshots = 0;
  bool wanted = true;
  const Callbacks callbacks{.snapshot_wanted = [&] { return std::exchange(wanted, false); },
                            .snapshot =
                                [&](const Picture& picture) {
                                  ++snapshots;
                                  mattes_of(picture);
                                }};
  const auto mattes = mattes_of(renderer.render(callbacks));
  EXPECT_EQ(snapshots, 1);
  EXPECT_GT(renderer.statistics().cryptomatte_seconds, 0.0);
  int pictures = 0;
  renderer.render_series({.spp = {1, 3}}, [&](int, const Picture& picture, const RenderStatistics&) {
    ++pictures;
    EXPECT_EQ(mattes_of(picture), mattes);
  });
  EXPECT_EQ(pictures, 2);
}

}  // namespace
}  // namespace gatelight::renderer
