// A step and answers of the reference: its records, counts and refusals.

#include "neural/reference/reference_backend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "tests/neural/agreement_loops.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

using testing::find_model_case;
using testing::make_batch;
using testing::OwnedBatch;

TEST(ReferenceBackend, BatchesWithSpansOfTheWrongLengthAreRefusedAndChangeNothing) {
  const auto model = find_model_case("gate_with_everything").model;
  const auto backend = make_reference_backend(model, {});
  const ModelState state = backend->export_state();
  const auto refuses = [&](auto change) {
    OwnedBatch batch = make_batch(*model, 5, 1);
    change(batch);
    EXPECT_THROW(backend->train(batch.training()), BadConfiguration);
    EXPECT_EQ(backend->export_state(), state);
  };
  const auto refuses_lengths = [&](auto... spans) {
    for (const std::size_t size : {0u, 4u, 6u})
      (refuses([&](OwnedBatch& b) { (b.*spans).resize(size); }), ...);
  };
  refuses_lengths(&OwnedBatch::surfaces, &OwnedBatch::triangles, &OwnedBatch::barycentrics,
                  &OwnedBatch::positions, &OwnedBatch::directions, &OwnedBatch::normals, &OwnedBatch::albedos,
                  &OwnedBatch::roughnesses, &OwnedBatch::targets);
  refuses([](OwnedBatch& b) { b.targets.pop_back(); });
  const OwnedBatch batch = make_batch(*model, 5, 1);
  std::vector<float> few(5 * 3 - 1);
  EXPECT_THROW(backend->query(batch.points(), {}, few), BadConfiguration);
  // Inputs that the model does not read may be empty, but not of another length.
  const auto gate_only = make_reference_backend(find_model_case("gate_only").model, {});
  OwnedBatch more = make_batch(*find_model_case("gate_only").model, 5, 1);
  EXPECT_EQ(gate_only->train(more.training()).records, 5u);
  more.normals.resize(5);
  EXPECT_EQ(gate_only->train(more.training()).records, 5u);
  more.normals.resize(3);
  EXPECT_THROW(gate_only->train(more.training()), BadConfiguration);
}

TEST(ReferenceBackend, OptionsOutOfRangeAreRefused) {
  const auto model = find_model_case("hash_F4").model;
  const auto refuses = [&](auto change) {
    TrainingOptions options;
    change(options);
    EXPECT_THROW(make_reference_backend(model, options), BadConfiguration);
  };
  refuses([](TrainingOptions& o) { o.average.ramp = 0; });
  refuses([](TrainingOptions& o) { o.max_target = 0; });
  refuses([](TrainingOptions& o) { o.feature_step = FeatureStep::per_triangle; });  // no triangles in a grid
}

TEST(ReferenceBackend, TargetsBeyondTheLimitAreClampedToIt) {
  const auto model = find_model_case("nao").model;
  TrainingOptions options{.max_target = 2.0f};
  const auto clamping = make_reference_backend(model, options),
             plain = make_reference_backend(model, options);
  OwnedBatch batch = make_batch(*model, 4, 1);
  batch.targets = {5.0f, -3e38f, 2.0f, 1.0f};
  EXPECT_EQ(clamping->train(batch.training()).clipped, 2u);
  batch.targets = {2.0f, -2.0f, 2.0f, 1.0f};
  EXPECT_EQ(plain->train(batch.training()).clipped, 0u);
  EXPECT_EQ(clamping->export_state(), plain->export_state());
}

TEST(ReferenceBackend, OutputBiasStartsAtTheMeanTargetOfTheFirstBatch) {
  const auto model = find_model_case("outputs_2").model;
  const LayerLayout& last = model->parameters.layers.back();
  TrainingOptions options;
  options.adam.learning_rate = 0;
  OwnedBatch batch = make_batch(*model, 4, 1);
  batch.targets = {1, 10, 2, 20, 3, 30, 6, -20};
  const auto backend = make_reference_backend(model, options);
  backend->train(batch.training());
  const auto bias = [&](std::size_t output) {
    return backend->export_state().parameters[last.biases + output];
  };
  EXPECT_EQ(bias(0), 3.0f);
  EXPECT_EQ(bias(1), 10.0f);
  EXPECT_EQ(backend->export_state().averages[last.biases], 3.0f);
  batch.targets.assign(8, 100.0f);
  backend->train(batch.training());
  EXPECT_EQ(bias(0), 3.0f);

  options.start_at_mean = false;
  const auto from_zero = make_reference_backend(model, options);
  from_zero->train(batch.training());
  EXPECT_EQ(from_zero->export_state().parameters[last.biases], 0.0f);
}

TEST(ReferenceBackend, CountsTheNodesWithANonZeroWeight) {
  const auto model = find_model_case("gate_L2_stack_3").model;
  const auto backend = make_reference_backend(model, {});
  OwnedBatch batch = make_batch(*model, 1, 1);
  batch.barycentrics = {{0.2f, 0.3f}};
  EXPECT_EQ(backend->train(batch.training()).touched_nodes, 3u);
  batch.barycentrics = {{0, 0}};  // on a node
  EXPECT_EQ(backend->train(batch.training()).touched_nodes, 1u);
  batch.barycentrics = {{0.5f, 0}};  // on an edge between two nodes
  EXPECT_EQ(backend->train(batch.training()).touched_nodes, 2u);
}

TEST(ReferenceBackend, WeightsWithANonFiniteGradientAreNotChanged) {
  const auto model = find_model_case("gate_only").model;
  const ParameterLayout& layout = model->parameters;
  TrainingOptions options{.loss = Loss::l2, .start_at_mean = false};
  const auto backend = make_reference_backend(model, options);
  ModelState state = backend->export_state();
  // The first output is infinite: so are all gradients but those of the other outputs' weights.
  const LayerLayout& last = layout.layers.back();
  state.parameters[last.weights] = std::numeric_limits<float>::infinity();
  backend->import_state(state);
  const OwnedBatch batch = make_batch(*model, 10, 1);
  const StepStatistics statistics = backend->train(batch.training());
  const std::uint64_t fine = (last.outputs - 1) * (last.inputs + 1);
  EXPECT_EQ(statistics.skipped_updates, layout.network_count() - fine + statistics.touched_nodes);
  const ModelState after = backend->export_state();
  for (std::size_t p = 0; p < layout.count; ++p) {
    const bool other_output = (p >= last.weights + last.inputs && p < last.biases) || p > last.biases;
    EXPECT_EQ(after.parameters[p] != state.parameters[p], other_output) << p;
    EXPECT_TRUE(std::isfinite(after.first_moments[p]));
    EXPECT_TRUE(std::isfinite(after.second_moments[p]));
  }
  EXPECT_EQ(after.node_steps, state.node_steps);
}

TEST(ReferenceBackend, AnswersAreClampedToTheirRange) {
  testing::expect_clamped_answers(*make_reference_backend(find_model_case("nrc").model, {}),
                                  QueryPrecision::fp32);
}

}  // namespace
}  // namespace gatelight::neural::reference
