#include "neural/learning/adam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "neural/reference/adam.h"
#include "neural/reference/encode.h"
#include "neural/reference/reference_backend.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

using testing::find_model_case;
using testing::make_batch;
using testing::OwnedBatch;

TEST(Adam, FollowsAnExampleWorkedByHand) {
  // lr 1/8, betas 1/2 and 3/4, gradients 2, 4, -8, from p = 1. t = 1: m = 1, v = 1; corrected 2 and 4: the
  // step is 1/8 x 2/2. t = 2: m = 1/2 + 2, v = 3/4 + 4; corrected by 3/4 and 7/16. t = 3: m = 5/4 - 4,
  // v = 57/16 + 16; corrected by 7/8 and 37/64.
  AdamOptions options;
  options.learning_rate = 0.125f;
  options.beta1 = 0.5f;
  options.beta2 = 0.75f;
  const double gradients[] = {2, 4, -8};
  const double first[] = {1, 2.5, -2.75}, second[] = {1, 4.75, 19.5625};
  const double steady[] = {0.875, 0.74854646277773250, 0.81608215434539130};
  const double decaying[] = {0.875, 0.76189651791028398, 0.81703917916586685};  // lr/sqrt(1 + (t-1)/4)
  for (const bool decays : {false, true}) {
    options.decay_steps = decays ? 4.0f : 0.0f;
    double p = 1;
    Moments moments;
    for (std::uint64_t t = 1; t <= 3; ++t) {
      p = adam(options, t, p, gradients[t - 1], moments);
      EXPECT_DOUBLE_EQ(moments.first, first[t - 1]);
      EXPECT_DOUBLE_EQ(moments.second, second[t - 1]);
      EXPECT_NEAR(p, decays ? decaying[t - 1] : steady[t - 1], 1e-14);
    }
  }
}

TEST(Adam, BiasCorrectionIsExactFromTheFirstStepToABillion) {
  // 1 - beta^t by squaring complements: c(a+b) = c(a) + c(b) - c(a) c(b), without cancellation.
  const auto expected = [](long double beta, std::uint64_t t) {
    long double result = 0, power = 1 - beta;
    for (; t != 0; t >>= 1, power = power * (2 - power))
      if (t & 1) result = result + power - result * power;
    return result;
  };
  for (const float beta : {0.0f, 0.5f, 0.9f, 0.99f, 0.999f, 0.99999f, std::nextafter(1.0f, 0.0f)}) {
    double last = 0;
    for (std::uint64_t t = 1; t <= 1000000000; t = t < 100 ? t + 1 : t * 7 / 5) {
      const double correction = bias_correction(beta, t);
      const double exact = static_cast<double>(expected(beta, t));
      ASSERT_NEAR(correction, exact, 1e-14 * exact) << "beta " << beta << ", t " << t;
      ASSERT_GE(correction, last);
      ASSERT_LE(correction, 1.0);
      last = correction;
    }
    EXPECT_DOUBLE_EQ(bias_correction(beta, 1), 1.0 - static_cast<double>(beta));
  }
}

struct Trained {
  ModelState before, after;
  std::vector<bool> touched;
};

/// Trains a step with one batch, then a step with another; `touched` are the nodes of the second batch.
Trained train_twice(const Model& model, const std::shared_ptr<const Model>& shared,
                    const TrainingOptions& options) {
  const auto backend = make_reference_backend(shared, options);
  backend->train(make_batch(model, 300, 1).training());
  Trained result;
  result.before = backend->export_state();
  const OwnedBatch second = make_batch(model, 20, 2);
  backend->train(second.training());
  result.after = backend->export_state();
  result.touched.resize(model.parameters.node_count, false);
  for (std::size_t r = 0; r < second.size(); ++r)
    for (const NodeWeight& node : encoding_nodes(model, read_point(model, second.points(), r)))
      if (node.weight != 0) result.touched[node.node] = true;
  return result;
}

TEST(Adam, SparseUpdatesLeaveUntouchedNodesAndDenseOnesMoveThem) {
  for (const char* name : {"nrc", "hash_F4"}) {
    SCOPED_TRACE(name);
    const auto shared = find_model_case(name).model;
    const Model& model = *shared;
    const std::size_t features = model.parameters.features;
    TrainingOptions options;
    const Trained sparse = train_twice(model, shared, options);
    options.update = FeatureUpdate::dense;
    const Trained dense = train_twice(model, shared, options);
    EXPECT_TRUE(dense.after.node_steps.empty());
    int untouched = 0;
    for (std::size_t node = 0; node < model.parameters.node_count; ++node) {
      const bool touched = sparse.touched[node];
      EXPECT_EQ(sparse.after.node_steps[node], sparse.before.node_steps[node] + (touched ? 1 : 0));
      for (std::size_t i = node * features; i < (node + 1) * features; ++i) {
        EXPECT_EQ(sparse.after.parameters[i] != sparse.before.parameters[i], touched);
        EXPECT_EQ(sparse.after.first_moments[i] != sparse.before.first_moments[i], touched);
        if (touched) continue;
        EXPECT_EQ(sparse.after.second_moments[i], sparse.before.second_moments[i]);
        EXPECT_EQ(sparse.after.averages[i], sparse.before.averages[i]);
        // Dense: moments decay by their beta, and where there is momentum the parameter moves on.
        EXPECT_FLOAT_EQ(dense.after.first_moments[i], 0.9f * dense.before.first_moments[i]);
        EXPECT_FLOAT_EQ(dense.after.second_moments[i], 0.99f * dense.before.second_moments[i]);
        if (dense.before.first_moments[i] != 0) {
          EXPECT_NE(dense.after.parameters[i], dense.before.parameters[i]);
          ++untouched;
        }
      }
    }
    EXPECT_GT(untouched, 0);
  }
}

/// A batch of one record.
OwnedBatch one_record(std::uint32_t surface, std::uint32_t triangle, Float2 barycentrics) {
  OwnedBatch batch;
  batch.surfaces = {surface};
  batch.triangles = {triangle};
  batch.barycentrics = {barycentrics};
  batch.targets = {1.0f};
  batch.fates = {testing::Fate::accepted};
  return batch;
}

TEST(Adam, CountersPerTriangleGiveTheNodeTheGreatestOfTheTrianglesThatTouchIt) {
  // Instance 1 is a sheet; its triangles 0 and 1 share the edge from vertex 0 to vertex 5.
  ModelConfig config = testing::default_gate_config();
  config.auxiliary.clear();
  config.gate.stack = {1};
  config.gate.features = 1;
  config.mlp.outputs = 1;
  const auto model_case = testing::make_case("per_triangle", config);
  TrainingOptions options;
  options.adam.decay_steps = 1.0f;
  options.feature_step = FeatureStep::per_triangle;
  const auto backend = make_reference_backend(model_case.model, options);
  const std::uint32_t surface = surface_index(1, 0);
  const std::uint32_t first = model_case.model->gate.surfaces[surface].first_triangle;
  const OwnedBatch left = one_record(surface, 0, {0.25f, 0.25f}),
                   right = one_record(surface, 1, {0.25f, 0.25f});
  for (int step = 0; step < 3; ++step) backend->train(left.training());
  backend->train(right.training());
  const ModelState before = backend->export_state();
  EXPECT_EQ(before.triangle_steps[first], 3u);
  EXPECT_EQ(before.triangle_steps[first + 1], 1u);

  // Both triangles at once: t is 4 for the nodes of the left one, 2 for the corner of only the right one.
  OwnedBatch both = left;
  both.surfaces.push_back(surface);
  both.triangles.push_back(1);
  both.barycentrics.push_back({0.25f, 0.25f});
  both.targets.push_back(1.0f);
  both.fates.push_back(testing::Fate::accepted);
  backend->train(both.training());
  const ModelState after = backend->export_state();
  EXPECT_EQ(after.triangle_steps[first], 4u);
  EXPECT_EQ(after.triangle_steps[first + 1], 2u);
  const auto nodes = [&](const OwnedBatch& batch) {
    return encoding_nodes(*model_case.model, read_point(*model_case.model, batch.points(), 0));
  };
  const auto expect_step = [&](std::uint32_t node, std::uint64_t t) {
    const double m = after.first_moments[node] / bias_correction(options.adam.beta1, t);
    const double v = after.second_moments[node] / bias_correction(options.adam.beta2, t);
    const double moved = learning_rate_at(options.adam, t) * m / std::sqrt(v);
    EXPECT_NEAR(before.parameters[node] - after.parameters[node], moved, 1e-5 * std::abs(moved) + 1e-9);
  };
  int alone = 0;
  for (const NodeWeight& node : nodes(left)) expect_step(node.node, 4);
  for (const NodeWeight& node : nodes(right)) {
    bool shared = false;
    for (const NodeWeight& other : nodes(left)) shared = shared || other.node == node.node;
    if (!shared) expect_step(node.node, 2), ++alone;
  }
  EXPECT_EQ(alone, 1);
}

TEST(Adam, L2RegularisesOnlyWeights) {
  const auto model_case = find_model_case("nrc");
  const ParameterLayout& layout = model_case.model->parameters;
  const OwnedBatch batch = make_batch(*model_case.model, 50, 4);
  TrainingOptions options;
  const auto moments = [&](float l2) {
    options.adam.l2_network = l2;
    const auto backend = make_reference_backend(model_case.model, options);
    backend->train(batch.training());
    return backend->export_state().first_moments;
  };
  const std::vector<float> without = moments(0), with = moments(0.5f);
  const ModelState initial = initial_state(*model_case.model, options);
  for (std::size_t p = 0; p < layout.network; ++p) EXPECT_EQ(with[p], without[p]);
  for (const LayerLayout& layer : layout.layers) {
    for (std::size_t p = layer.weights; p < layer.biases; ++p)
      EXPECT_NEAR(with[p] - without[p], 0.1f * 0.5f * initial.parameters[p], 1e-6);
    for (std::size_t p = layer.biases; p < layer.biases + layer.outputs; ++p) EXPECT_EQ(with[p], without[p]);
  }
}

}  // namespace
}  // namespace gatelight::neural::reference
