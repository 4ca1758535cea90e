// Pictures with an alpha, and before other backgrounds; views that change.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/image_write.h"
#include "renderer/render.h"
#include "tests/support/denoiser.h"
#include "tests/support/materials.h"
#include "tests/support/messages.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;
using tests::TemporaryFolder;
using Kind = BackgroundOptions::Kind;

constexpr int kWidth = 32, kHeight = 24;

/// From left to right: a matte box, a blended sheet, a pane, and a block of glass.
SceneBuilder row_of_objects() {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color(0.6f, 0.4f, 0.2f))), Vec3(-4, -1, -1),
              Vec3(-2.4f, 1, 1));
  scene::Material sheet = SceneBuilder::lambert(Color::Constant(0.5f));
  sheet.alpha_mode = scene::AlphaMode::blend;
  sheet.base_alpha = 0.3f;
  sheet.double_sided = true;
  builder.quad(builder.material(sheet), Vec3(-2, -1, 0), Vec3(1.6f, 0, 0), Vec3(0, 2, 0));
  scene::Material pane = SceneBuilder::clear_glass();
  pane.base_color = Color(0.9f, 0.5f, 0.7f);
  builder.quad(builder.material(pane), Vec3(0, -1, 0), Vec3(1.6f, 0, 0), Vec3(0, 2, 0));
  builder.box(builder.material(testing::solid_glass()), Vec3(2, -1, -1), Vec3(3.6f, 1, 1));
  return builder;
}

RenderOptions options_for(Integrator integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.width = kWidth;
  options.height = kHeight;
  options.spp = 16;
  options.camera.look_at = LookAt{{0, 0, 12}, {0, 0, 0}, {0, 1, 0}};
  options.environment.constant = Color(0.2f, 0.5f, 0.9f);
  options.cache.train_steps = 4;
  options.cache.batch = 512;
  return options;
}

Picture rendered(const scene::Scene& scene, const RenderOptions& options) {
  return Renderer(scene, options).render();
}

const float* pixel(const Picture& picture, int x, int y) {
  const Layer& beauty = picture.layers.front();
  return &beauty.values[static_cast<std::size_t>(y * picture.width + x) * beauty.channels.size()];
}

TEST(Background, ATransparentPictureOverTheEnvironmentIsTheScene) {
  SceneBuilder builder = row_of_objects();
  for (const Integrator integrator : {Integrator::path, Integrator::nrc, Integrator::ao}) {
    RenderOptions options = options_for(integrator);
    const Color sky = integrator == Integrator::ao ? Color::Ones() : options.environment.constant;
    const Picture whole = rendered(builder.scene(), options);
    options.background.kind = Kind::transparent;
    const Picture apart = rendered(builder.scene(), options);
    ASSERT_EQ(apart.layers.front().channels.back(), "A");
    ASSERT_EQ(apart.layers.size(), 1u) << "the layer of the alpha was not requested";
    testing::Moments errors;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float *a = pixel(apart, x, y), *w = pixel(whole, x, y);
        // The pane's tint is a colour and alpha one number: its luminance is right.
        const Color difference(w[0] - a[0], w[1] - a[1], w[2] - a[2]);
        errors.add(static_cast<double>(luminance(difference) - (1.0f - a[3]) * luminance(sky)));
        if (integrator == Integrator::ao) {
          EXPECT_NEAR(errors.mean(), 0.0, 1e-4) << x << "," << y;
        }
      }
    }
    // Weak light undergoes roulette by the mean of the pixel so far, which includes the sky.
    EXPECT_GT(testing::mean_p_value(errors, 0.0), testing::sidak(1e-4, 9))
        << errors.mean() << " +- " << errors.standard_error() << ", integrator "
        << static_cast<int>(integrator);
    // The box, the sheet, the block of glass, and nothing.
    EXPECT_FLOAT_EQ(pixel(apart, 8, 12)[3], 1.0f);
    EXPECT_NEAR(pixel(apart, 13, 12)[3], 0.3f, 0.07f);
    EXPECT_FLOAT_EQ(pixel(apart, 22, 12)[3], 1.0f);
    EXPECT_FLOAT_EQ(pixel(apart, 16, 1)[3], 0.0f);
    EXPECT_FLOAT_EQ(pixel(apart, 16, 1)[1], 0.0f);
    if (integrator != Integrator::ao) {
      EXPECT_GT(pixel(apart, 18, 12)[3], 0.2f);
      EXPECT_LT(pixel(apart, 18, 12)[3], 0.6f);
    }
  }
}

/// The sum of pixels of a sheet of alpha 0.3, by the law of independent samples. The denoiser keeps means.
void expect_alpha(double sum, int pixels, int samples) {
  const double error = std::sqrt(0.3 * 0.7 / (pixels * samples));
  EXPECT_GT(testing::normal_two_sided((sum / pixels - 0.3) / error), testing::sidak(1e-4, 9))
      << sum / pixels << " +- " << error;
}

/// A blended sheet of alpha 0.3 over the whole view, before nothing.
Picture sheet_of(const Color& emission, bool denoised) {
  SceneBuilder builder;
  scene::Material sheet = SceneBuilder::lambert(Color::Constant(0.5f), emission);
  sheet.alpha_mode = scene::AlphaMode::blend;
  sheet.base_alpha = 0.3f;
  builder.quad(builder.material(sheet), Vec3(-50, -50, 0), Vec3(100, 0, 0), Vec3(0, 100, 0));
  RenderOptions options = options_for(Integrator::path);
  options.background.kind = Kind::transparent;
  options.spp = 64;
  if (denoised) testing::denoise(options);
  return rendered(builder.scene(), options);
}

TEST(Background, BlendedSheetsAreSampledEvenly) {
  const Picture picture = sheet_of(Color::Zero(), false);
  double squares = 0.0;
  int count = 0;
  // In one of the two triangles.
  for (int y = 14; y < 22; ++y) {
    for (int x = 20; x < 30; ++x, ++count) {
      const double d = static_cast<double>(pixel(picture, x, y)[3]) - 0.3;
      squares += d * d;
    }
  }
  // Independent numbers would have 0.057.
  EXPECT_LT(std::sqrt(squares / count), 0.02);
}

TEST(Background, AColourShinesThroughByAlpha) {
  SceneBuilder builder = row_of_objects();
  RenderOptions options = options_for(Integrator::path);
  options.background.kind = Kind::transparent;
  const Picture apart = rendered(builder.scene(), options);
  options.background = {.kind = Kind::color, .color = {0.1f, 2.0f, 0.3f}, .file = {}};
  const Picture before = rendered(builder.scene(), options);
  ASSERT_EQ(before.layers.front().channels.size(), 3u);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float* a = pixel(apart, x, y);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixel(before, x, y)[c], a[c] + (1.0f - a[3]) * options.background.color[c], 1e-5f);
    }
  }
}

TEST(Background, AnEmissiveSheetHasItsAlphaToo) {
  GATELIGHT_NEEDS_DENOISER();
  const Picture picture = sheet_of(Color::Constant(4.0f), true);
  double sum = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) sum += static_cast<double>(pixel(picture, x, y)[3]);
  }
  expect_alpha(sum, kWidth * kHeight, 64);
}

/// A picture whose red is its column and green its row.
void write_grid(const std::filesystem::path& file, int width, int height) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      values.insert(values.end(), {static_cast<float>(x), static_cast<float>(y), 0.0f});
  }
  write_image(testing::rgb(width, height, std::move(values)), file, {.exr_float = true});
}

TEST(Background, AFileCoversTheViewAndARegionShowsItsPart) {
  const TemporaryFolder folder;
  const scene::Scene nothing = SceneBuilder().scene();
  RenderOptions options = options_for(Integrator::path);
  options.spp = 1;
  options.background = {.kind = Kind::file, .color = Color::Zero(), .file = (folder / "grid.exr").string()};
  write_grid(folder / "grid.exr", kWidth, kHeight);
  options.region = {5, 3, 20, 17};
  const Picture region = rendered(nothing, options);
  EXPECT_EQ(pixel(region, 2, 4)[0], 7.0f);
  EXPECT_EQ(pixel(region, 2, 4)[1], 7.0f);
  // Twice as large and wider: its middle is visible, half as large.
  write_grid(folder / "grid.exr", 2 * kWidth + 20, 2 * kHeight);
  options.region.reset();
  const Picture whole = rendered(nothing, options);
  EXPECT_NEAR(pixel(whole, 10, 8)[0], 10 + 2 * 10 + 0.5f, 0.1f);
  EXPECT_NEAR(pixel(whole, 10, 8)[1], 2 * 8 + 0.5f, 0.1f);
  // Infinite values and NaN, behind opaque pixels and without them.
  write_image(testing::uniform(kWidth, kHeight, {kInfinity, 1.0f, std::nanf("")}), folder / "grid.exr",
              {.exr_float = true});
  SceneBuilder wall;
  wall.quad(wall.material(SceneBuilder::lambert(Color::Zero())), Vec3(-50, -50, 0), Vec3(100, 0, 0),
            Vec3(0, 100, 0));
  const Picture opaque = rendered(wall.scene(), options);
  for (const float value : opaque.layers.front().values) ASSERT_LT(std::abs(value), 1e-6f);
  const Picture open = rendered(nothing, options);
  EXPECT_EQ(pixel(open, 3, 3)[0], 65504.0f);
  EXPECT_EQ(pixel(open, 3, 3)[2], 0.0f);
  options.background.file = (folder / "missing.exr").string();
  tests::expect_message(tests::refusal<InputError>([&] { Renderer(nothing, options); }), {"missing.exr"});
}

TEST(Background, TheAlphaIsDenoisedToo) {
  GATELIGHT_NEEDS_DENOISER();
  SceneBuilder builder = row_of_objects();
  RenderOptions options = options_for(Integrator::path);
  options.width *= 4;
  options.height *= 4;
  options.spp = 4;
  options.sampler = SamplerKind::independent;
  options.background.kind = Kind::transparent;
  const auto spread = [&] {
    const Picture picture = rendered(builder.scene(), options);
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (int y = 42; y < 54; ++y) {
      for (int x = 48; x < 57; ++x, ++count) {
        const double a = static_cast<double>(pixel(picture, x, y)[3]);
        sum += a;
        squares += a * a;
      }
    }
    expect_alpha(sum, count, 4);
    return std::sqrt(squares / count - sum * sum / count / count);
  };
  const double raw = spread();
  testing::denoise(options);
  EXPECT_LT(spread(), 0.5 * raw);
}

/// A floor at y = 0, seen from above, and something else.
scene::Scene floor_with(SceneBuilder builder) {
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 50);
  scene::Scene scene = builder.scene();
  scene.instances.back().name = "floor";
  return scene;
}

RenderOptions catching(Integrator integrator) {
  RenderOptions options = options_for(integrator);
  options.camera.look_at = LookAt{{0, 10, 0}, {0, 0, 0}, {0, 0, -1}};
  options.camera.fov_degrees = 45.0f;
  options.environment.constant = Color::Zero();
  options.background = {
      .kind = Kind::transparent, .color = Color::Zero(), .file = {}, .shadow_catcher = "floor"};
  return options;
}

TEST(ShadowCatcher, IsInvisibleExceptForTheShadowOfASun) {
  SceneBuilder builder;
  // Under a low sun from +x the plate's shadow lies beside it.
  builder.box(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(1, 1.9f, -1),
              Vec3(3, 2, 1));
  scene::Scene scene = floor_with(builder);
  scene.lights.push_back(testing::sun(Vec3(-1, -1, 0)));
  GATELIGHT_NEEDS_DENOISER();
  for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
    for (const bool denoised : {false, true}) {
      RenderOptions options = catching(integrator);
      if (denoised) testing::denoise(options);
      const Picture picture = rendered(scene, options);
      // 12 pixels are tan(22.5 degrees) * 10 m: the shadow is from x = -1 to 1 m, the plate beside it.
      const float shadow = pixel(picture, 15, 12)[3], open = pixel(picture, 8, 12)[3];
      EXPECT_NEAR(shadow, 1.0f, denoised ? 0.05f : 1e-6f);
      EXPECT_NEAR(open, 0.0f, denoised ? 0.05f : 1e-6f);
      for (const int x : {15, 8}) EXPECT_NEAR(pixel(picture, x, 12)[0], 0.0f, denoised ? 0.02f : 0.0f);
      EXPECT_NEAR(pixel(picture, 23, 12)[3], 1.0f, 0.05f) << "the plate";
      EXPECT_GT(pixel(picture, 23, 12)[0], 0.1f);
    }
  }
}

TEST(ShadowCatcher, ShowsThePartOfTheSkyThatAWallHides) {
  SceneBuilder builder;
  const float edge = -1.5f;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(edge, 0, 50),
               Vec3(0, 0, -100), Vec3(0, 3, 0));
  const scene::Scene scene = floor_with(builder);
  RenderOptions options = catching(Integrator::path);
  options.environment.constant = Color(0.3f, 0.6f, 0.9f);
  options.spp = 256;
  const Picture picture = rendered(scene, options);
  for (const int x : {16, 20, 26}) {
    testing::Moments column;
    for (int y = 4; y < 20; ++y) column.add(static_cast<double>(pixel(picture, x, y)[3]));
    // An endless wall of height h at the distance d hides (1 - cos(atan(h / d))) / 2 of the irradiance.
    const double d = (x + 0.5 - 16.0) / 12.0 * std::tan(M_PI / 8.0) * 10.0 - static_cast<double>(edge);
    const double expected = 0.5 * (1.0 - d / std::hypot(d, 3.0));
    EXPECT_GT(testing::mean_p_value(column, expected), testing::sidak(1e-4, 9))
        << x << ": " << column.mean() << " +- " << column.standard_error() << ", expected " << expected;
  }
}

TEST(ShadowCatcher, NeedsAnAlphaAndAnObjectThatIsThere) {
  const scene::Scene scene = floor_with(SceneBuilder());
  RenderOptions options = catching(Integrator::path);
  options.background.shadow_catcher = "table";
  tests::expect_refused_parts<BadOption>([&] { rendered(scene, options); },
                                         {"shadow-catcher", "table", "", "'floor'"});
  options.background.shadow_catcher = "floor";
  options.background.kind = Kind::scene;
  tests::expect_refused_parts<BadOption>([&] { rendered(scene, options); },
                                         {"shadow-catcher", "floor", "alpha", "`background`"});
}

TEST(SetCamera, GivesTheBitsOfARendererOfThatView) {
  SceneBuilder builder = row_of_objects();
  for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
    RenderOptions options = options_for(integrator);
    options.spp = 2;
    Renderer renderer(builder.scene(), options);
    const Picture first = renderer.render();
    CameraOptions other;
    other.look_at = LookAt{{6, 5, 9}, {0, 0, 0}, {0, 1, 0}};
    renderer.set_camera(other);
    const Picture second = renderer.render();
    options.camera = other;
    EXPECT_EQ(second.layers.front().values, rendered(builder.scene(), options).layers.front().values);
    EXPECT_NE(second.layers.front().values, first.layers.front().values);
    EXPECT_THROW(renderer.set_camera({.name = "none"}), BadOption);
    EXPECT_EQ(renderer.render().layers.front().values, second.layers.front().values) << "the view stays";
  }
}

TEST(Focus, WithoutADistanceIsAtTheHitOfTheMiddle) {
  SceneBuilder builder = row_of_objects();
  RenderOptions options = options_for(Integrator::path);
  options.spp = 1;
  options.camera.look_at = LookAt{{-3.2f, 0, 12}, {-3.2f, 0, 0}, {0, 1, 0}};
  options.camera.lens.aperture = 0.2f;
  Renderer renderer(builder.scene(), options);
  const std::vector<std::string>& warnings = renderer.statistics().warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
    return text.find("`focus` 11 ") != std::string::npos;
  }));
  const Picture by_middle = renderer.render();
  options.camera.lens.focus = "11";
  EXPECT_EQ(rendered(builder.scene(), options).layers.front().values, by_middle.layers.front().values);
}

}  // namespace
}  // namespace gatelight::renderer
