// Light of an earlier frame in a film.

#include "renderer/temporal/history.h"

#include <gtest/gtest.h>

#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::view_from;

constexpr int kWidth = 32, kHeight = 24;
constexpr PixelRect kRect{0, 0, kWidth, kHeight};
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// A wall before the camera, and a film of it with four samples a pixel, equal or of twice the light and
/// none.
struct Wall {
  explicit Wall(const scene::Material& material) {
    builder.quad(builder.material(material), Vec3(-9, -9, 0), Vec3(18, 0, 0), Vec3(0, 18, 0));
    world.emplace(builder.scene());
  }

  Film film(float radiance, float albedo, bool noise = false) const {
    Film film(kRect, kWidth, kHeight, {.guides = true});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int s = 0; s < 4; ++s) {
          const PixelSample sample = film.take(Pixel{x, y});
          FirstHit first;
          first.hit = true;
          first.guide = {true, 0, Color::Ones(), Color::Constant(albedo), Vec3::UnitZ()};
          film.add(sample, Color::Constant(noise ? static_cast<float>(2 * (s % 2)) * radiance : radiance));
          film.add(sample, first);
        }
      }
    }
    return film;
  }

  /// A history of uniform light. `probe` is negative for none.
  History history(const Camera& from, float radiance, float samples, float probe) const {
    History h{.view = {SceneSnapshot(), from}, .rect = kRect};
    h.points = trace_visible_points(*world, from, kRect, nullptr).now;
    h.color.assign(3 * kPixels, radiance);
    h.samples.assign(kPixels, samples);
    if (probe >= 0.0f) h.probes.assign(kPixels, Color::Constant(probe));
    return h;
  }

  Reuse reuse(const Film& film, const History& history, float probe = -1.0f) const {
    std::vector<Color> probes;
    if (probe >= 0.0f) probes.assign(kPixels, Color::Constant(probe));
    return reuse_samples(film, trace_visible_points(*world, camera, kRect, &history.view), std::move(probes),
                         &history);
  }

  /// Where each surface's material has changed so much.
  Reuse reuse_changed(const Film& film, const History& history, float change) const {
    VisiblePoints points = trace_visible_points(*world, camera, kRect, &history.view);
    points.changes.assign(kPixels, change);
    return reuse_samples(film, std::move(points), {}, &history);
  }

  SceneBuilder builder;
  std::optional<World> world;
  Camera camera{view_from(Vec3(0, 0, 4), Vec3::Zero()), kWidth, kHeight};
};

scene::Material matte() {
  return SceneBuilder::lambert(Color::Constant(0.5f));
}

class ReusedSamples : public ::testing::Test {
 protected:
  /// With 12 samples of a radiance of 1.
  History usual_history() const { return wall.history(wall.camera, 1.0f, 12.0f, -1.0f); }

  const Wall wall{matte()};
};

TEST_F(ReusedSamples, AreWeightedByTheirNumbers) {
  const Reuse reuse = wall.reuse(wall.film(1.0f, 0.5f, true), usual_history());
  EXPECT_EQ(reuse.share, 1.0);
  for (const float samples : reuse.samples) EXPECT_NEAR(samples, 16.0f, 1e-4f);
  std::vector<float> denoised(3 * kPixels, 0.9f);
  mix_light(reuse, kRect, denoised);
  for (const float color : denoised) EXPECT_NEAR(color, (4.0f * 0.9f + 12.0f * 1.0f) / 16.0f, 1e-4f);
}

TEST_F(ReusedSamples, LeaveDetailsToTheFrame) {
  const Reuse reuse = wall.reuse(wall.film(1.0f, 0.5f, true), usual_history());
  std::vector<float> denoised(3 * kPixels);
  const auto sign = [](std::size_t pixel) { return (pixel + pixel / kWidth) % 2 == 0 ? 1.0f : -1.0f; };
  for (std::size_t i = 0; i < denoised.size(); ++i) denoised[i] = 1.0f + 0.2f * sign(i / 3);
  mix_light(reuse, kRect, denoised);
  for (std::size_t i = 0; i < denoised.size(); ++i)
    EXPECT_NEAR(denoised[i], 1.0f + 0.5f * 0.2f * sign(i / 3), 0.02f);
}

TEST_F(ReusedSamples, AreAsBrightAsThoseOfTheFrame) {
  const Reuse reuse = wall.reuse(wall.film(1.0f, 0.5f, true), wall.history(wall.camera, 1.1f, 12.0f, -1.0f));
  EXPECT_EQ(reuse.share, 1.0) << "within the noise of 9 x 9 pixels";
  for (const float color : reuse.color) EXPECT_NEAR(color, 1.0f, 0.02f) << "known from all pixels";
  const Reuse unsure =
      wall.reuse(wall.film(1.0f, 0.5f, true), wall.history(wall.camera, 1.02f, 12.0f, -1.0f));
  for (const float color : unsure.color) EXPECT_NEAR(color, 1.02f, 1e-3f) << "within the noise of all";
}

TEST_F(ReusedSamples, NearEdgesAreNotCarried) {
  Wall with_edge(matte());
  with_edge.builder.quad(0, Vec3(-9, -9, 1), Vec3(9, 0, 0), Vec3(0, 18, 0));  // the left half, nearer
  with_edge.world.emplace(with_edge.builder.scene());
  const Reuse reuse = with_edge.reuse(with_edge.film(1.0f, 0.5f, true),
                                      with_edge.history(with_edge.camera, 1.0f, 12.0f, -1.0f));
  int edges = 0;
  for (int x = 0; x < kWidth; ++x) {
    const std::size_t i = kRect.index(x, kHeight / 2);
    edges += reuse.samples[i] == 0.0f ? 1 : 0;
    EXPECT_EQ(reuse.samples[i] == 0.0f, reuse.weight[i] == 0.0f) << x;
  }
  EXPECT_GE(edges, 4);
  EXPECT_LE(edges, 8);
}

TEST_F(ReusedSamples, AreAtMostSoMany) {
  const Reuse reuse = wall.reuse(wall.film(1.0f, 0.5f), wall.history(wall.camera, 1.0f, 1e6f, -1.0f));
  for (const float samples : reuse.samples) EXPECT_NEAR(samples, 4.0f * (1.0f + kMaxEarlier), 1e-2f);
}

TEST_F(ReusedSamples, ComeFromWhereThePointWas) {
  const Camera beside(view_from(Vec3(1, 0, 4), Vec3(1, 0, 0)), kWidth, kHeight);
  History history = wall.history(beside, 0.0f, 12.0f, -1.0f);
  for (std::size_t i = 0; i < kPixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      history.color[3 * i + c] = 9.0f + 0.02f * history.points[i].position.x();
  }
  const Film film = wall.film(9.0f, 0.5f, true);
  const Reuse reuse = wall.reuse(film, history);
  int seen = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (!(reuse.samples[i] > 15.0f)) continue;
    ++seen;
    EXPECT_NEAR(reuse.color[3 * i], 9.0f + 0.02f * reuse.points.now[i].position.x(), 1e-3f);
  }
  EXPECT_GT(seen, static_cast<int>(kPixels) / 2);
  EXPECT_LT(seen, static_cast<int>(kPixels)) << "a part was not in the earlier picture";
}

TEST_F(ReusedSamples, AreNotTakenFromAnotherLight) {
  const Film film = wall.film(1.0f, 0.5f);
  EXPECT_EQ(wall.reuse(film, wall.history(wall.camera, 1.0f, 12.0f, 3.0f), 1.0f).share, 0.0)
      << "probes differ";
  EXPECT_EQ(wall.reuse(film, wall.history(wall.camera, 2.0f, 12.0f, 1.0f), 1.0f).share, 0.0)
      << "samples differ, without noise";
  EXPECT_EQ(wall.reuse(film, wall.history(wall.camera, 1.0f, 12.0f, 1.0f), 1.0f).share, 1.0);
  History red = wall.history(wall.camera, 1.0f, 12.0f, 1.0f);
  red.probes.assign(kPixels, Color(1.0f / luminance(Color(1, 0, 0)), 0.0f, 0.0f));
  EXPECT_EQ(wall.reuse(film, red, 1.0f).share, 0.0) << "another hue, as bright";
}

TEST_F(ReusedSamples, TakeTheHueOfTheProbes) {
  History history = wall.history(wall.camera, 1.0f, 12.0f, 1.0f);
  history.probes.assign(kPixels, Color(1.0f, 1.02f, 1.0f));
  const Reuse reuse = wall.reuse(wall.film(1.0f, 0.5f, true), history, 1.0f);
  EXPECT_EQ(reuse.share, 1.0);
  for (std::size_t i = 0; i < kPixels; ++i) {
    EXPECT_NEAR(reuse.color[3 * i], 1.0f, 1e-3f);
    EXPECT_NEAR(reuse.color[3 * i + 1], 1.0f / 1.02f, 1e-3f);
  }
}

TEST_F(ReusedSamples, AreNotTakenFromAnotherMaterial) {
  const Film film = wall.film(1.0f, 0.5f, true);
  const History history = usual_history();
  EXPECT_EQ(wall.reuse_changed(film, history, 0.5f).share, 0.0);
  const Reuse little = wall.reuse_changed(film, history, 0.02f);
  for (const float weight : little.weight) EXPECT_NEAR(weight * 0.02f, 0.01f, 0.005f);
  for (const float weight : wall.reuse_changed(film, history, 0.0f).weight) EXPECT_NEAR(weight, 0.75f, 1e-4f);
}

TEST_F(ReusedSamples, BehindOtherSurfacesAreNotTaken) {
  History history = usual_history();
  for (VisiblePoint& point : history.points) point.layers = 1;
  EXPECT_EQ(wall.reuse(wall.film(1.0f, 0.5f, true), history).share, 0.0) << "a pane that is gone";
}

TEST_F(ReusedSamples, FollowSlowChangesThatAddUp) {
  // The noise of the samples hides each change.
  constexpr float kStep = 0.005f;
  History history = usual_history();
  float light = 1.0f;
  for (int frame = 0; frame < 30; ++frame) {
    light *= 1.0f + kStep;
    const Reuse reuse = wall.reuse_changed(wall.film(light, 0.5f, true), history, kStep);
    EXPECT_EQ(reuse.share, 1.0);
    history.color.assign(3 * kPixels, light);
    mix_light(reuse, kRect, history.color);
    history.samples = reuse.samples;
    for (const float color : history.color) ASSERT_NEAR(color / light, 1.0f, 0.011f) << frame;
  }
}

TEST_F(ReusedSamples, OfMetalsNeedTheSameReflection) {
  scene::Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.3f;
  const Wall of_metal(metal);
  const Film film = of_metal.film(1.0f, 0.5f);
  const auto mean_samples = [&](const Camera& from) {
    const Reuse reuse = of_metal.reuse(film, of_metal.history(from, 1.0f, 12.0f, -1.0f));
    return reuse.samples[kRect.index(kWidth / 2, kHeight / 2)];
  };
  EXPECT_NEAR(mean_samples(of_metal.camera), 16.0f, 1e-3f);
  EXPECT_NEAR(mean_samples(Camera(view_from(Vec3(1, 0, 4), Vec3::Zero()), kWidth, kHeight)), 4.0f, 0.1f);
}

}  // namespace
}  // namespace gatelight::renderer
