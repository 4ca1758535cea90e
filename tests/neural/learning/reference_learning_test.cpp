// The reference learns functions over a tessellated sphere.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "neural/reference/reference_backend.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

using testing::OwnedBatch;
using testing::OwnedSurfaces;

/// The outputs at a point of the sphere.
using Field = std::function<std::vector<float>(const Float3&)>;

struct Sphere {
  OwnedSurfaces surfaces;
  std::shared_ptr<const Model> model;

  explicit Sphere(std::uint32_t outputs) {
    surfaces.meshes = {testing::make_sphere(1)};
    surfaces.instances = {{}};
    ModelConfig config;
    config.gate.features = 4;
    config.gate.stack = {4, 1};
    config.gate.rule = ResolutionRule::fixed;
    config.gate.cluster = false;
    config.mlp.width = 16;
    config.mlp.outputs = outputs;
    model = make_model(config, surfaces.layout());
  }

  OwnedBatch records(std::size_t size, std::uint64_t seed, const Field& field) const {
    OwnedBatch batch = testing::make_batch(*model, size, seed, {.crowded = 0});
    batch.targets.clear();
    for (std::size_t r = 0; r < size; ++r) {
      const auto& corners = surfaces.meshes[0].triangles[batch.triangles[r]];
      const float u = batch.barycentrics[r][0], v = batch.barycentrics[r][1];
      Float3 p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = (1 - u - v) * surfaces.meshes[0].positions[corners[0]][axis] +
                  u * surfaces.meshes[0].positions[corners[1]][axis] +
                  v * surfaces.meshes[0].positions[corners[2]][axis];
      const float length = std::hypot(p[0], p[1], p[2]);
      for (const float value : field({p[0] / length, p[1] / length, p[2] / length}))
        batch.targets.push_back(value);
    }
    return batch;
  }

  /// Root of the mean squared error of queries.
  double error(const Backend& backend, const Field& field) const {
    const OwnedBatch points = records(400, 12345, field);
    std::vector<float> out(points.targets.size());
    QueryOptions options;
    options.range = OutputRange::raw;
    backend.query(points.points(), options, out);
    double sum = 0;
    for (std::size_t i = 0; i < out.size(); ++i) sum += std::pow(out[i] - points.targets[i], 2);
    return std::sqrt(sum / static_cast<double>(out.size()));
  }

  /// The errors after `steps` and after four times as many.
  std::array<double, 2> learn(const Field& field, std::uint64_t steps) const {
    TrainingOptions options;
    options.loss = Loss::l2;
    const auto backend = make_reference_backend(model, options);
    std::array<double, 2> errors;
    for (std::uint64_t step = 0; step < 4 * steps; ++step) {
      backend->train(records(128, step, field).training());
      if (step + 1 == steps) errors[0] = error(*backend, field);
    }
    errors[1] = error(*backend, field);
    return errors;
  }
};

TEST(ReferenceLearning, AConstantIsLearned) {
  const auto [early, late] = Sphere(1).learn([](const Float3&) { return std::vector<float>{0.7f}; }, 25);
  EXPECT_LT(early, 0.02);
  EXPECT_LT(late, 0.005);
}

TEST(ReferenceLearning, ARampIsLearned) {
  const auto [early, late] = Sphere(1).learn([](const Float3& p) { return std::vector<float>{p[2]}; }, 30);
  EXPECT_LT(late, 0.5 * early);
  EXPECT_LT(late, 0.03);  // its deviation is 0.58
}

TEST(ReferenceLearning, SphericalHarmonicsOfOneBandAreLearned) {
  // The five functions of l = 2; the deviation of each is sqrt(1 / 4 pi) = 0.28.
  const Field band = [](const Float3& p) {
    const auto [x, y, z] = p;
    return std::vector<float>{1.0925484f * x * y, 1.0925484f * y * z, 0.31539157f * (3 * z * z - 1),
                              1.0925484f * x * z, 0.54627422f * (x * x - y * y)};
  };
  const auto [early, late] = Sphere(5).learn(band, 75);
  EXPECT_LT(late, 0.5 * early);
  EXPECT_LT(late, 0.03);
}

}  // namespace
}  // namespace gatelight::neural::reference
