// The state of the reference: export, import and the precision of features.

#include <gtest/gtest.h>

#include <vector>

#include "base/half.h"
#include "neural/reference/reference_backend.h"
#include "tests/support/agreement.h"

namespace gatelight::neural::reference {
namespace {

using testing::find_model_case;
using testing::make_batch;
using testing::OwnedBatch;

TEST(ReferenceState, QueriesReadRoundedFeaturesAndMastersStayInFp32) {
  const auto model = find_model_case("nrc").model;
  const auto holds = [&](const ModelState& state) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < model->parameters.network; ++p)
      count += half_to_float(float_to_half(state.parameters[p])) == state.parameters[p] &&
               half_to_float(float_to_half(state.averages[p])) == state.averages[p];
    return count;
  };
  const OwnedBatch points = make_batch(*model, 50, 7);
  for (const FeaturePrecision precision : {FeaturePrecision::fp16, FeaturePrecision::fp16_masters}) {
    TrainingOptions options{.precision = precision};
    const auto backend = make_reference_backend(model, options);
    for (std::uint64_t step = 0; step < 5; ++step) backend->train(make_batch(*model, 300, step).training());
    ModelState state = backend->export_state();
    if (precision == FeaturePrecision::fp16)
      EXPECT_EQ(holds(state), model->parameters.network);
    else
      EXPECT_LT(holds(state), model->parameters.network * 9 / 10);
    // A backend in fp32 with the rounded features gives the same answers.
    const std::vector<float> half = testing::answers(*backend, *model, points, {});
    for (std::size_t p = 0; p < model->parameters.network; ++p)
      state.averages[p] = half_to_float(float_to_half(state.averages[p]));
    const auto rounded = make_reference_backend(model, {});
    rounded->import_state(state);
    const std::vector<float> full = testing::answers(*rounded, *model, points, {});
    for (std::size_t i = 0; i < half.size(); ++i) EXPECT_NEAR(half[i], full[i], 1e-5f);
  }
}

TEST(ReferenceState, TrainingReadsRoundedMasters) {
  // Masters between two halves give the loss that the half gives.
  const auto model = find_model_case("gate_only").model;
  TrainingOptions options{.precision = FeaturePrecision::fp16_masters, .start_at_mean = false};
  const OwnedBatch batch = make_batch(*model, 30, 7);
  const auto loss = [&](double offset) {
    const auto backend = make_reference_backend(model, options);
    ModelState state = backend->export_state();
    for (std::size_t p = 0; p < model->parameters.network; ++p)
      state.parameters[p] = static_cast<float>((p % 5 + 1) * (1 + offset));
    backend->import_state(state);
    return backend->train(batch.training()).loss;
  };
  EXPECT_EQ(loss(0.0), loss(1e-4));
  EXPECT_NE(loss(0.0), loss(1e-2));
}

}  // namespace
}  // namespace gatelight::neural::reference
