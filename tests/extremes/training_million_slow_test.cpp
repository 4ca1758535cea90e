// Training: a million steps.

#include <tbb/global_control.h>

#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;

constexpr std::uint64_t kSteps = 1'000'000;
constexpr std::uint64_t kPart = 100'000;
constexpr std::size_t kRecords = 16;

/// Light on a sheet over [0,1]^2.
double truth(double x, double y) {
  return 0.6 + 0.4 * std::sin(5.0 * x) * std::cos(4.0 * y);
}

struct Points {
  OwnedBatch batch;
  std::vector<double> values;
};

void fill(const OwnedMesh& mesh, Random& random, float noise, Points& points) {
  for (std::size_t r = 0; r < points.batch.size(); ++r) {
    const std::uint32_t triangle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
    Float2 b = {random.unit(), random.unit()};
    if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1]};
    const auto& corners = mesh.triangles[triangle];
    const auto at = [&](std::size_t axis) {
      return (1 - b[0] - b[1]) * mesh.positions[corners[0]][axis] + b[0] * mesh.positions[corners[1]][axis] +
             b[1] * mesh.positions[corners[2]][axis];
    };
    points.batch.triangles[r] = triangle;
    points.batch.barycentrics[r] = b;
    points.values[r] = truth(at(0), at(1));
    points.batch.targets[r] = static_cast<float>(points.values[r]) + random.between(-noise, noise);
  }
}

Points make_points(std::size_t count) {
  Points points;
  points.batch.surfaces.assign(count, 0);
  points.batch.triangles.assign(count, 0);
  points.batch.barycentrics.assign(count, {});
  points.batch.targets.assign(count, 0);
  points.batch.fates.assign(count, Fate::accepted);
  points.values.assign(count, 0);
  return points;
}

TEST(ExtremeLength, AMillionStepsStayFiniteAndDoNotDrift) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);  // 16 records a batch
  const OwnedMesh mesh = make_sheet(4, 0.0f, 1);
  ModelConfig config = default_gate_config();
  config.gate.features = 4;
  config.gate.stack = {4};
  config.auxiliary.clear();
  config.mlp = {.width = 16, .hidden_layers = 1, .outputs = 1};
  SurfaceLayout surfaces;
  surfaces.meshes = {{mesh.positions, mesh.triangles}};
  surfaces.instances = {{.mesh = 0}};
  const auto model = make_model(config, surfaces);
  const auto backend = cpu::make_cpu_backend(model, {});
  Random random{1};
  Points seen = make_points(kRecords), queried = make_points(500);
  fill(mesh, random, 0.0f, queried);

  double first = 0, last = 0, worst = 0;
  for (std::uint64_t step = 1; step <= kSteps; ++step) {
    fill(mesh, random, 0.3f, seen);
    const StepStatistics s = backend->train(seen.batch.training());
    ASSERT_TRUE(std::isfinite(s.loss)) << step;
    ASSERT_EQ(s.skipped_updates, 0u) << step;
    if (step % kPart != 0) continue;
    const std::vector<float> out = raw_answers(*backend, *model, queried.batch);
    double squares = 0;
    for (std::size_t i = 0; i < out.size(); ++i) squares += std::pow(out[i] - queried.values[i], 2) / 500.0;
    last = std::sqrt(squares);
    if (first == 0) first = last;
    worst = std::max(worst, last);
  }
  expect_finite(*backend, queried.batch, *model);
  const ModelState state = backend->export_state();
  EXPECT_EQ(state.steps, kSteps);
  double greatest = 0;
  for (const float p : state.parameters) greatest = std::max(greatest, std::abs(static_cast<double>(p)));
  EXPECT_LE(first, 0.05);
  EXPECT_LE(worst, 1.2 * first);
  EXPECT_LE(greatest, 30.0);
}

}  // namespace
}  // namespace gatelight::neural
