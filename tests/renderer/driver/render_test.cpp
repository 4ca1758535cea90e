// Results that do not depend on chance: bits, passes, regions, refusals.

#include "renderer/render.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "base/errors.h"
#include "tests/renderer/image/kinds_of_pictures.h"
#include "tests/support/messages.h"
#include "tests/support/room.h"

namespace gatelight::renderer {

namespace {

using testing::room;
using testing::small_picture;

TEST(Render, AnyNumberOfThreadsGivesTheSameBitsAndCountsRaysOnce) {
  const scene::Scene s = room();
  RenderOptions options = small_picture();
  for (const Integrator integrator : {Integrator::path, Integrator::ao}) {
    options.integrator = integrator;
    options.threads = 1;
    Renderer renderer(s, options);
    const Picture one = renderer.render();
    const RayCounts rays = renderer.statistics().rays;
    EXPECT_EQ(rays.camera, 50u * 40u * 6u);
    EXPECT_EQ(rays.bounce > 0, integrator == Integrator::path);
    EXPECT_GT(rays.shadow, 0u);
    for (const int threads : {2, 7}) {
      options.threads = threads;
      Renderer other(s, options);
      kinds::expect_same({other.render(), other.statistics()}, {one, renderer.statistics()});
    }
  }
}

TEST(Render, ARegionIsThatPartOfTheWhole) {
  const scene::Scene s = room();
  RenderOptions options = small_picture();
  const Picture whole = Renderer(s, options).render();
  options.region = {{16, 16, 48, 32}};  // whole tiles: the same batches of rays, hence the same bits
  const Picture part = Renderer(s, options).render();
  ASSERT_EQ(part.width, 32);
  ASSERT_EQ(part.height, 16);
  for (int y = 0; y < part.height; ++y) {
    for (int i = 0; i < part.width * 3; ++i) {
      ASSERT_EQ(part.layers[0].values[static_cast<std::size_t>(y * part.width * 3 + i)],
                whole.layers[0].values[static_cast<std::size_t>(((y + 16) * whole.width + 16) * 3 + i)]);
    }
  }
}

TEST(Render, StopsAfterThePassOnRequest) {
  const scene::Scene s = room();
  RenderOptions options = small_picture();
  options.spp = 1 << 20;
  options.aovs.push_back(Aov::sample_count);
  Renderer renderer(s, options);
  Callbacks callbacks;
  std::atomic<int> calls{0};
  callbacks.stop = [&] { return ++calls > 40; };
  const Picture picture = renderer.render(callbacks);
  EXPECT_TRUE(renderer.statistics().interrupted);
  EXPECT_LT(renderer.statistics().spp, 1000);
  for (float count : picture.find("samples")->values) {
    ASSERT_EQ(count, static_cast<float>(renderer.statistics().spp));
  }
}

TEST(Render, InstancedEqualsFlattened) {
  scene::Scene flat = room();
  scene::Scene instanced = flat;
  for (scene::Instance& instance : instanced.instances) {
    // The same place by a transform: the mesh moved away and the instance moved back.
    for (Vec3& p : instanced.meshes[static_cast<std::size_t>(instance.mesh)].positions) p -= Vec3(1, 2, -3);
    instance.transform = Affine(Eigen::Translation3f(1, 2, -3));
    instance.baked = false;
  }
  const RenderOptions options = small_picture();
  const Picture a = Renderer(flat, options).render();
  const Picture b = Renderer(instanced, options).render();
  // The same random numbers and the same geometry but for rounding: nearly every pixel agrees, and so does
  // the mean.
  std::size_t different = 0;
  double sum_a = 0.0;
  double sum_b = 0.0;
  const std::vector<float>& va = a.layers[0].values;
  const std::vector<float>& vb = b.layers[0].values;
  for (std::size_t i = 0; i < va.size(); ++i) {
    different += std::abs(va[i] - vb[i]) > 0.01f * (0.01f + va[i]);
    sum_a += static_cast<double>(va[i]);
    sum_b += static_cast<double>(vb[i]);
  }
  EXPECT_LT(different, va.size() / 20);
  EXPECT_NEAR(sum_a, sum_b, 0.01 * sum_a);
}

TEST(Render, TheFirst16NonFiniteSamplesAreLocatedWhateverThreadTracesThem) {
  scene::Scene s = room();
  s.materials[1].emission.setConstant(kInfinity);  // the lamp
  RenderOptions options = small_picture();
  options.spp = 1;
  std::vector<std::array<std::uint32_t, 3>> first;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    Renderer renderer(s, options);
    renderer.render();
    ASSERT_GT(renderer.statistics().nonfinite, 16u);
    std::vector<std::array<std::uint32_t, 3>> located;
    for (const NonFiniteSample& n : renderer.statistics().nonfinite_samples)
      located.push_back({static_cast<std::uint32_t>(n.y), static_cast<std::uint32_t>(n.x), n.sample});
    EXPECT_EQ(located.size(), 16u);
    EXPECT_TRUE(std::is_sorted(located.begin(), located.end()));
    if (threads == 1) first = located;
    EXPECT_EQ(located, first);
    RenderOptions strict = options;
    strict.nan_policy = NanPolicy::error;
    tests::expect_message(tests::refusal<NumericalError>([&] { Renderer(s, strict).render(); }),
                          {fmt::format("pixel {},{}", located[0][1], located[0][0]), "sample 0"});
  }
}

TEST(Render, ClampBoundsSamplesAndIsCounted) {
  const scene::Scene s = room();
  RenderOptions options = small_picture();
  options.clamp = 0.1f;
  Renderer renderer(s, options);
  const Picture picture = renderer.render();
  EXPECT_GT(renderer.statistics().clamped, 0u);
  for (std::size_t i = 0; i < picture.layers[0].values.size(); i += 3) {
    const float* p = &picture.layers[0].values[i];
    ASSERT_LE(luminance(Color(p[0], p[1], p[2])), 0.1001f);
  }
}

}  // namespace
}  // namespace gatelight::renderer
