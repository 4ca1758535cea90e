#pragma once
// Every fast backend of this machine against the reference in double precision, at an extreme.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/parity.h"

namespace gatelight::neural::testing {

using Backends = std::vector<std::unique_ptr<Backend>>;

/// Scalar, AVX2 and AVX-512, as far as the processor has them.
inline Backends fast_backends(const std::shared_ptr<const Model>& model, const TrainingOptions& options) {
  Backends backends;
  for (const simd::Isa isa : simd::available_isas())
    backends.push_back(cpu::make_cpu_backend(model, options, isa));
  return backends;
}

inline bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

inline std::vector<float> raw_answers(const Backend& backend, const Model& model, const OwnedBatch& batch,
                                      bool averaged = true, QueryPrecision precision = QueryPrecision::fp32) {
  std::vector<float> out(batch.size() * model.config.mlp.outputs, -7.0f);
  backend.query(batch.points(), {precision, OutputRange::raw, averaged}, out);
  return out;
}

/// Expects no NaN and no infinity in state and answers, and no negative second moment.
inline void expect_sound(const Backend& backend, const Model& model, const OwnedBatch& batch) {
  const ModelState state = backend.export_state();
  EXPECT_TRUE(all_finite(state.parameters)) << backend.name();
  EXPECT_TRUE(all_finite(state.averages)) << backend.name();
  EXPECT_TRUE(all_finite(state.first_moments)) << backend.name();
  EXPECT_TRUE(all_finite(state.second_moments)) << backend.name();
  EXPECT_GE(*std::min_element(state.second_moments.begin(), state.second_moments.end()), 0.0f);
  std::vector<float> out(batch.size() * model.config.mlp.outputs);
  for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16}) {
    backend.query(batch.points(), {precision, OutputRange::non_negative, true}, out);
    EXPECT_TRUE(all_finite(out)) << backend.name();
  }
}

/// The tolerances of kernel_parity_test, which neural/cpu/README.md lists.
struct Tolerances {
  double answers = 3e-5, loss = 3e-5, gradients = 3e-5, squares = 6e-5, parameters = 3e-5;
};
inline Tolerances tolerances_of(const Model& model) {
  if (model.config.encoding != FeatureEncoding::hash_grid) return {};
  return {5e-5, 5e-5, 5e-5, 1e-4, 5e-5};
}

using MakeBackends = std::function<Backends(const std::shared_ptr<const Model>&, const TrainingOptions&)>;

/// The worst difference from the reference so far, relative to its tolerance.
class Agreement {
 public:
  explicit Agreement(MakeBackends make = fast_backends) : make_(std::move(make)) {}

  /// Compares answers before and after `steps` steps, and all that the steps change. The options must make a
  /// step a smooth function of the gradient (make_smooth), and the batch must stay away from kinks.
  void expect_same(const std::string& where, const ModelCase& c, const TrainingOptions& options,
                   const ModelState& state, const OwnedBatch& batch, int steps = 1) {
    const Model& model = *c.model;
    const Tolerances most = tolerances_of(model);
    const auto reference = reference::make_reference_backend(c.model, options);
    reference->import_state(state);
    const std::vector<float> answers = raw_answers(*reference, model, batch);
    StepStatistics expected;
    for (int step = 0; step < steps; ++step) expected = reference->train(batch.training());
    const ModelState after = reference->export_state();
    const std::vector<bool> doubtful = doubtful_nodes(model, batch);
    for (const auto& fast : make_(c.model, options)) {
      SCOPED_TRACE(fmt::format("{}: {}, {}", where, c.name, fast->name()));
      fast->import_state(state);
      meet_backend(fast->name());
      meet(relative_difference(raw_answers(*fast, model, batch), answers), most.answers, "answers");
      StepStatistics s;
      for (int step = 0; step < steps; ++step) s = fast->train(batch.training());
      const ModelState got = fast->export_state();
      EXPECT_EQ(s.records, expected.records);
      EXPECT_EQ(s.rejected, expected.rejected);
      EXPECT_EQ(s.unstored, expected.unstored);
      EXPECT_EQ(s.clipped, expected.clipped);
      EXPECT_EQ(s.skipped_updates, expected.skipped_updates);
      EXPECT_EQ(got.steps, after.steps);
      EXPECT_EQ(got.triangle_steps, after.triangle_steps);
      std::vector<bool> without(model.parameters.node_count, false);
      for (std::size_t n = 0; n < got.node_steps.size(); ++n) {
        without[n] = got.node_steps[n] != after.node_steps[n];
        EXPECT_TRUE(!without[n] || doubtful[n]) << "node " << n;
      }
      const auto differ = [&](const std::vector<float>& a, const std::vector<float>& b) {
        return tensor_difference(model, a, b, without);
      };
      meet(std::abs(s.loss - expected.loss) / std::max(expected.loss, 1e-30), most.loss, "loss");
      meet(differ(got.first_moments, after.first_moments), most.gradients, "gradients");
      meet(differ(got.second_moments, after.second_moments), most.squares, "squares of gradients");
      if (options.precision == FeaturePrecision::fp16) {
        meet(differ(got.parameters, after.parameters), 0x1p-9, "fp16 parameters");
        continue;
      }
      meet(differ(got.parameters, after.parameters), most.parameters, "parameters");
      meet(differ(got.averages, after.averages), most.parameters, "averages");
    }
  }

  void meet(double difference, double tolerance, const char* what) {
    EXPECT_LE(difference, tolerance) << what;
    if (difference / tolerance < worst_ / bound_) return;
    worst_ = difference;
    bound_ = tolerance;
    what_ = what;
  }

  /// Text for the table.
  std::string text() const {
    std::string names;
    for (const std::string& name : backends_) names += (names.empty() ? "" : ", ") + name;
    return fmt::format("{} beside the reference: {} off by {:.1e} (bound {:.0e})", names, what_, worst_,
                       bound_);
  }

 private:
  void meet_backend(const std::string& name) {
    if (std::find(backends_.begin(), backends_.end(), name) == backends_.end()) backends_.push_back(name);
  }

  MakeBackends make_;
  std::vector<std::string> backends_;
  double worst_ = 0, bound_ = 1;
  const char* what_ = "";
};

}  // namespace gatelight::neural::testing
