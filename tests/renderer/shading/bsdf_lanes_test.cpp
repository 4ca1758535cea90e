// Every lane of the wide BSDF against the scalar one: over random materials, at grazing angles and extremes.

#include <algorithm>
#include <cmath>

#include "renderer/transport/scattering.h"
#include "tests/renderer/shading/lanes.h"

namespace gatelight::renderer {
namespace {

using namespace lanes;

constexpr int kBlocks = 3000;

std::vector<LanePoint> fill(ShadingBlock& block, Random& random, int count = ShadingBlock::kWidth) {
  block = {};
  std::vector<LanePoint> points;
  for (int lane = 0; lane < count; ++lane) {
    points.push_back(random_point(random));
    put(block, points.back());
  }
  return points;
}

/// The largest difference, over the magnitude of both.
struct Worst {
  double value = 0.0;
  int far = 0;  ///< beyond the tolerance
  int all = 0;

  void meet(double a, double b, double tolerance, double floor) {
    const double difference = std::abs(a - b) / std::max({std::abs(a), std::abs(b), floor});
    ++all;
    if (difference <= tolerance) {
      value = std::max(value, difference);
    } else {
      ++far;
    }
  }
};

/// Expects fewer than this share beyond the tolerance.
void expect_few(const char* name, const Worst& worst, double share) {
  std::printf("%-12s worst %.2e, %d of %d beyond the tolerance\n", name, worst.value, worst.far, worst.all);
  EXPECT_LT(worst.far, share * worst.all) << name;
}

TEST(BsdfLanes, AlbedosAreThoseOfTheScalarCode) {
  Random random(1);
  Worst worst;
  for (int b = 0; b < kBlocks; ++b) {
    ShadingBlock block;
    const std::vector<LanePoint> points = fill(block, random);
    const ShadingBlock alone = run_all(block, tables_only(), &ShadingKernels::albedo);
    const ShadingBlock result = run_all(block, tables_only(), &ShadingKernels::scatter);
    for (int lane = 0; lane < block.count; ++lane) {
      const LanePoint& p = points[lane];
      const Color expected = p.bsdf().albedo();
      // A viewer almost in the horizon bends the normal, and cosines there have few digits.
      const double tolerance = p.wo.dot(p.surface.geometric_normal) < 2e-3f ? 5e-3 : 1e-4;
      for (int c = 0; c < 3; ++c) {
        worst.meet(result.albedo[c][lane], expected[c], tolerance, 0.1);
        ASSERT_EQ(alone.albedo[c][lane], result.albedo[c][lane]);
      }
    }
  }
  expect_few("albedo", worst, 1e-4);
}

// A light of radiance 1 and pdf 1: `direct` is the value. With the balance heuristic the weight gives the
// pdf.
TEST(BsdfLanes, ValuesAndPdfsAreThoseOfTheScalarCode) {
  Random random(2);
  ShadingContext context = tables_only();
  context.heuristic = MisHeuristic::balance;
  Worst values, pdfs;
  for (int b = 0; b < kBlocks; ++b) {
    ShadingBlock block;
    const std::vector<LanePoint> points = fill(block, random);
    std::vector<Vec3> wis;
    for (int lane = 0; lane < block.count; ++lane) {
      const LanePoint& p = points[lane];
      Vec3 wi = random_above(random, random.uniform_float() < 0.7f ? p.surface.geometric_normal
                                                                   : Vec3(-p.surface.geometric_normal));
      if (random.uniform_float() < 0.3f) {  // near the mirror direction, or that of a sheet
        wi = (2.0f * p.wo.dot(p.surface.shading_normal) * p.surface.shading_normal - p.wo +
              0.05f * random.uniform_float() * random_direction(random))
                 .normalized();
        if (random.uniform_float() < 0.3f) wi = -p.wo;
      }
      wis.push_back(wi);
      put_light(block, lane, wi, true, 1.0f);
    }
    const ShadingBlock valued = run_all(block, context, &ShadingKernels::scatter);
    for (int lane = 0; lane < block.count; ++lane) put_light(block, lane, wis[lane], false, 1.0f);
    const ShadingBlock weighted = run_all(block, context, &ShadingKernels::scatter);
    for (int lane = 0; lane < block.count; ++lane) {
      const Bsdf bsdf = points[lane].bsdf();
      if (bsdf.is_delta()) {
        for (int c = 0; c < 3; ++c) ASSERT_EQ(valued.direct[c][lane], 0.0f);
        continue;
      }
      const BsdfValue expected = bsdf.evaluate(wis[lane]);
      // Where the direction lies in the horizon, rounding decides on which side.
      const Vec3& ng = points[lane].surface.geometric_normal;
      if (std::abs(wis[lane].dot(ng)) < 1e-6f) continue;
      for (int c = 0; c < 3; ++c) {
        values.meet(valued.direct[c][lane], expected.value[c], 2e-2, 1e-3);
        const auto value = static_cast<double>(valued.direct[c][lane]);
        if (value > 1e-3)
          pdfs.meet(value / static_cast<double>(weighted.direct[c][lane]) - 1.0,
                    static_cast<double>(expected.pdf), 2e-2, 1e-2);
      }
    }
  }
  expect_few("value", values, 5e-4);
  expect_few("pdf", pdfs, 1e-4);
  // Those beyond the tolerance are narrow lobes at grazing angles, where the last digits of a normal decide.
}

TEST(BsdfLanes, SamplesAreThoseOfTheScalarCode) {
  Random random(3);
  Worst directions, weights, pdfs;
  int lanes = 0, other = 0;
  for (int b = 0; b < kBlocks; ++b) {
    ShadingBlock block;
    const std::vector<LanePoint> points = fill(block, random);
    const ShadingBlock result = run_all(block, tables_only(), &ShadingKernels::scatter);
    for (int lane = 0; lane < block.count; ++lane) {
      const LanePoint& p = points[lane];
      const BsdfSample expected = p.sample(p.bsdf());
      const bool goes_on = expected.pdf > 0.0f && (expected.weight > 0.0f).any();
      ++lanes;
      if (goes_on != (result.alive[lane] != 0) ||
          (goes_on && (expected.delta != (result.is_delta[lane] != 0) ||
                       expected.transmitted != (result.transmitted[lane] != 0)))) {
        ++other;  // a random number at the border between two lobes, or a direction in the horizon
        continue;
      }
      if (!goes_on) continue;
      const Vec3 wi = lane_vector(result.wi, lane);
      if ((wi - expected.wi).norm() > 0.01f) {
        ++other;
        continue;
      }
      directions.meet((wi - expected.wi).norm(), 0.0, 1e-2, 1.0);
      pdfs.meet(result.pdf[lane], expected.pdf, 3e-2, 1e-3);
      for (int c = 0; c < 3; ++c) weights.meet(result.weight[c][lane], expected.weight[c], 1e-2, 1e-2);
      ASSERT_EQ(result.survival[lane], 1.0f);
      ASSERT_NEAR(result.spread[lane], expected.spread, 1e-6f);
      ASSERT_EQ(result.next_seed[lane], next_seed(p.seed));
      const Vec3 origin = p.surface.spawn(wi);
      ASSERT_LT((lane_vector(result.next_origin, lane) - origin).norm(), 1e-6f);
    }
  }
  expect_few("direction", directions, 1e-3);
  expect_few("weight", weights, 1e-3);
  expect_few("sample pdf", pdfs, 1e-3);
  std::printf("%d of %d samples are of another lobe\n", other, lanes);
  EXPECT_LT(other, 2e-3 * lanes);
}

TEST(BsdfLanes, WidePartsAreThoseOfTheScalarCode) {
  Random random(6);
  Worst albedos, values, weights;
  for (const float roughness : {0.0f, 0.25f, 0.6f}) {
    ShadingContext context = tables_only();
    context.separates_wide = true;
    context.min_roughness = roughness;
    for (int b = 0; b < kBlocks / 3; ++b) {
      ShadingBlock block;
      const std::vector<LanePoint> points = fill(block, random);
      std::vector<Vec3> wis;
      for (int lane = 0; lane < block.count; ++lane) {
        wis.push_back(random_above(random, points[lane].surface.geometric_normal));
        put_light(block, lane, wis[lane], true, 1.0f);
      }
      const ShadingBlock result = run_all(block, context, &ShadingKernels::scatter);
      for (int lane = 0; lane < block.count; ++lane) {
        const LanePoint& p = points[lane];
        if (p.wo.dot(p.surface.geometric_normal) < 2e-3f ||
            std::abs(wis[lane].dot(p.surface.geometric_normal)) < 1e-4f)
          continue;
        const Bsdf bsdf = p.bsdf();
        const Bsdf wide = bsdf.wide_part(roughness);
        const Color value = wide.evaluate(wis[lane]).value;
        for (int c = 0; c < 3; ++c) {
          albedos.meet(result.wide_albedo[c][lane], wide.albedo()[c], 1e-4, 0.1);
          if (!bsdf.is_delta()) values.meet(result.wide_direct[c][lane], value[c], 2e-2, 1e-3);
        }
        if (!result.alive[lane]) continue;
        const Color of_wide =
            result.is_delta[lane]
                ? Color(Color::Zero())
                : Color(wide.evaluate(lane_vector(result.wi, lane)).value / result.pdf[lane]);
        for (int c = 0; c < 3; ++c) weights.meet(result.wide_weight[c][lane], of_wide[c], 2e-2, 1e-2);
      }
    }
  }
  expect_few("wide albedo", albedos, 1e-4);
  expect_few("wide value", values, 5e-4);
  expect_few("wide weight", weights, 1e-3);
}

TEST(BsdfLanes, NarrowPartsAreThoseOfTheScalarCode) {
  Random random(7);
  Worst values, weights, pdfs;
  int lanes = 0, other = 0;
  for (const float roughness : {0.0f, 0.25f, 0.6f}) {
    ShadingContext context = tables_only();
    context.separates_wide = true;
    context.min_roughness = roughness;
    ShadingContext narrow_only = context;
    narrow_only.narrow_only = true;
    narrow_only.roulette = {2.0f, 0.9f, 0};
    for (int b = 0; b < kBlocks / 3; ++b) {
      ShadingBlock block;
      const std::vector<LanePoint> points = fill(block, random);
      std::vector<Vec3> wis;
      for (int lane = 0; lane < block.count; ++lane) {
        wis.push_back(random_above(random, points[lane].surface.geometric_normal));
        put_light(block, lane, wis[lane], true, 1.0f);
        block.events_before_roulette[lane] = 0;
        for (int c = 0; c < 3; ++c) block.throughput[c][lane] = 0.3f;
      }
      const ShadingBlock whole = run_all(block, context, &ShadingKernels::scatter);
      const ShadingBlock light = run_all(block, context, &ShadingKernels::light);
      const ShadingBlock result = run_all(block, narrow_only, &ShadingKernels::scatter);
      for (int lane = 0; lane < block.count; ++lane) {
        const LanePoint& p = points[lane];
        for (int c = 0; c < 3; ++c) {
          ASSERT_EQ(result.albedo[c][lane], whole.albedo[c][lane]);
          ASSERT_EQ(result.wide_albedo[c][lane], whole.wide_albedo[c][lane]);
          ASSERT_EQ(light.albedo[c][lane], whole.albedo[c][lane]);
          ASSERT_EQ(light.wide_albedo[c][lane], whole.wide_albedo[c][lane]);
          ASSERT_EQ(light.direct[c][lane], whole.direct[c][lane]);
          ASSERT_EQ(light.wide_direct[c][lane], whole.wide_direct[c][lane]);
        }
        if (p.wo.dot(p.surface.geometric_normal) < 2e-3f ||
            std::abs(wis[lane].dot(p.surface.geometric_normal)) < 1e-4f)
          continue;
        const Bsdf narrow = p.bsdf().narrow_part(roughness);
        const Color value = narrow.is_delta() ? Color(Color::Zero()) : narrow.evaluate(wis[lane]).value;
        for (int c = 0; c < 3; ++c) values.meet(result.direct[c][lane], value[c], 2e-2, 1e-3);
        const BsdfSample expected = p.sample(narrow);
        const float survival = std::min(0.9f, 2.0f * std::sqrt((0.3f * expected.weight).maxCoeff()));
        const bool goes_on = expected.pdf > 0.0f && (expected.weight > 0.0f).any() &&
                             roulette_number(next_seed(p.seed)) < survival;
        ++lanes;
        if (goes_on != (result.alive[lane] != 0) ||
            (goes_on && (lane_vector(result.wi, lane) - expected.wi).norm() > 0.01f)) {
          ++other;
          continue;
        }
        if (!goes_on) continue;
        pdfs.meet(result.pdf[lane], expected.pdf, 3e-2, 1e-3);
        for (int c = 0; c < 3; ++c)
          weights.meet(result.weight[c][lane] * result.survival[lane], expected.weight[c], 1e-2, 1e-2);
      }
    }
  }
  expect_few("narrow value", values, 5e-4);
  expect_few("weight", weights, 1e-3);
  expect_few("sample pdf", pdfs, 1e-3);
  std::printf("%d of %d samples differ\n", other, lanes);
  EXPECT_LT(other, 2e-3 * lanes);
}

TEST(BsdfLanes, RouletteIsThatOfTheScalarCode) {
  Random random(4);
  int ended = 0, survived = 0;
  for (int b = 0; b < kBlocks / 10; ++b) {
    ShadingBlock block = {};
    std::vector<LanePoint> points;
    for (int lane = 0; lane < ShadingBlock::kWidth; ++lane) {
      LanePoint p = random_point(random);
      p.throughput = Color::Constant(1.1f * random.uniform_float());
      p.events_before_roulette = static_cast<int>(random.uniform_float() * 4.0f) - 1;
      if (b % 4 == 0) p.events_before_roulette -= 66;
      points.push_back(p);
      put(block, p);
    }
    ShadingBlock without = block;
    for (std::uint32_t& events : without.events_before_roulette) events = 1000;
    const ShadingBlock played = run_all(block, tables_only(), &ShadingKernels::scatter);
    const ShadingBlock plain = run_all(without, tables_only(), &ShadingKernels::scatter);
    for (int lane = 0; lane < block.count; ++lane) {
      if (!plain.alive[lane]) {
        ASSERT_FALSE(played.alive[lane]);
        continue;
      }
      const LanePoint& p = points[lane];
      const bool pane = plain.is_delta[lane] && plain.transmitted[lane];
      const bool plays = (pane ? 0 : 1) >= p.events_before_roulette;
      const Color throughput = p.throughput * lane_color(plain.weight, lane);
      const float most = p.events_before_roulette <= -64 ? 0.99f : 1.0f;
      const float survival = plays ? std::min(most, std::sqrt(throughput.maxCoeff())) : 1.0f;
      ASSERT_FLOAT_EQ(played.survival[lane], survival);
      const bool survives = !plays || roulette_number(next_seed(p.seed)) < survival;
      ASSERT_EQ(played.alive[lane] != 0, survives);
      (survives ? survived : ended) += plays;
      if (!survives) continue;
      for (int c = 0; c < 3; ++c) ASSERT_FLOAT_EQ(played.weight[c][lane], plain.weight[c][lane] / survival);
    }
  }
  EXPECT_GT(ended, 200);
  EXPECT_GT(survived, 200);
}

TEST(BsdfLanes, ALaneDoesNotDependOnTheOthers) {
  Random random(5);
  for (int count = 1; count <= ShadingBlock::kWidth; ++count) {
    ShadingBlock block;
    const std::vector<LanePoint> points = fill(block, random, count);
    // Data left from other points must not matter.
    ShadingBlock dirty;
    std::memset(static_cast<void*>(&dirty), 0xff, sizeof dirty);  // NaN everywhere
    dirty.count = 0;
    for (const LanePoint& p : points) put(dirty, p);
    for (int lane = 0; lane < count; ++lane) {
      put_light(block, lane, points[lane].surface.geometric_normal, false, 0.5f);
      put_light(dirty, lane, points[lane].surface.geometric_normal, false, 0.5f);
    }
    const ShadingBlock clean = run_all(block, tables_only(), &ShadingKernels::scatter);
    const ShadingBlock result = run_all(dirty, tables_only(), &ShadingKernels::scatter);
    for (int lane = 0; lane < count; ++lane) {
      ShadingBlock alone = {};
      put(alone, points[lane]);
      put_light(alone, 0, points[lane].surface.geometric_normal, false, 0.5f);
      const ShadingBlock one = run_all(alone, tables_only(), &ShadingKernels::scatter);
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(one.direct[c][0], result.direct[c][lane]);
        ASSERT_EQ(one.weight[c][0], result.weight[c][lane]);
        ASSERT_EQ(one.wi[c][0], clean.wi[c][lane]);
        ASSERT_EQ(one.wi[c][0], result.wi[c][lane]);
      }
      ASSERT_EQ(one.alive[0], result.alive[lane]);
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
