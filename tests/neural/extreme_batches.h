#pragma once
// Batches at the limits of floats: no weight of a backend may become NaN or infinite.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include "tests/support/parity.h"

namespace gatelight::neural::testing {

inline constexpr float kGreatestFloat = std::numeric_limits<float>::max();

inline std::vector<ModelCase> usual_cases() {
  return {find_model_case("nrc"), find_model_case("hash_with_everything"),
          find_model_case("plain_with_everything")};
}

inline void expect_finite(const Backend& backend, const OwnedBatch& batch, const Model& model) {
  const ModelState state = backend.export_state();
  const auto finite = [](const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
  };
  EXPECT_TRUE(finite(state.parameters));
  EXPECT_TRUE(finite(state.averages));
  EXPECT_TRUE(finite(state.first_moments));
  EXPECT_TRUE(finite(state.second_moments));
  EXPECT_TRUE(
      std::all_of(state.second_moments.begin(), state.second_moments.end(), [](float v) { return v >= 0; }));
  for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16})
    for (const OutputRange range : {OutputRange::non_negative, OutputRange::unit}) {
      std::vector<float> out(batch.size() * model.config.mlp.outputs);
      backend.query(batch.points(), {precision, range}, out);
      EXPECT_TRUE(finite(out));
    }
}

/// Trains from the backend's state with each of these targets.
inline void expect_finite_for_targets(Backend& backend, const Model& model,
                                      std::initializer_list<float> targets) {
  const ModelState start = backend.export_state();
  for (const float target : targets) {
    SCOPED_TRACE(fmt::format("target {}", target));
    backend.import_state(start);
    OwnedBatch batch = make_batch(model, 50, 1);
    for (int step = 0; step < 6; ++step) {
      // The same sign, alternating by step, alternating by record and output.
      for (std::size_t i = 0; i < batch.targets.size(); ++i) {
        const bool negative = step >= 4 ? i % 2 == 1 : step >= 2 && step % 2 == 1;
        batch.targets[i] = negative ? -target : target;
      }
      EXPECT_EQ(backend.train(batch.training()).records, 50u);
    }
    expect_finite(backend, batch, model);
  }
}

/// Trains from the backend's state with each of these values as inputs, which are finite, but not sensible.
inline void expect_finite_for_inputs(Backend& backend, const Model& model,
                                     std::initializer_list<float> values) {
  const ModelState start = backend.export_state();
  for (const float value : values) {
    SCOPED_TRACE(fmt::format("input {}", value));
    backend.import_state(start);
    OwnedBatch batch = make_batch(model, 60, 2);
    for (std::size_t r = 0; r < batch.size(); ++r) {
      const float sign = r % 2 == 0 ? 1.0f : -1.0f;
      const auto set = [&](auto& span, std::size_t kind) {
        if (span.empty() || r % 7 == kind) return;
        for (std::size_t i = 0; i < span[r].size(); ++i)
          if (r % 3 != i) span[r][i] = r % 5 == i ? -sign * value : sign * value;
      };
      set(batch.barycentrics, 0);
      set(batch.positions, 1);
      set(batch.directions, 2);
      set(batch.normals, 3);
      set(batch.albedos, 4);
      if (!batch.roughnesses.empty() && r % 7 != 5) batch.roughnesses[r] = sign * value;
    }
    for (int step = 0; step < 4; ++step) EXPECT_EQ(backend.train(batch.training()).rejected, 0u);
    expect_finite(backend, make_batch(model, 60, 3), model);
    expect_finite(backend, batch, model);
  }
}

}  // namespace gatelight::neural::testing
