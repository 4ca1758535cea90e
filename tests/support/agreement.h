#pragma once
// Checks that fast backends agree with the reference in double precision.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/parity.h"

namespace gatelight::neural::testing {

// Differences are relative to the greatest magnitude in the same tensor (or in a batch's answers). A float
// has a relative error of 2^-24 = 6e-8. Sums of up to 256 terms, sums over records that nearly cancel, and
// positions among 64 nodes or bins have errors of up to 8e-6. Squares (second moments) have twice the error.
inline constexpr double kTolerance = 3e-5;
// A float position among a level's 256 to 466 cells has that many fewer digits within the cell.
inline constexpr double kHashGridTolerance = 5e-5;
// The last bit of a float can round a feature to the next fp16 number: one step of fp16, and one more for an
// average. This happens to few features.
inline constexpr double kHalfTolerance = 0x1p-9;
inline constexpr double kHalfShare = 0.02;
// Inputs, weights and activations of bf16 queries have eight significant bits, so each product has an error
// of up to 2^-8. Bound of the worst answer.
inline constexpr double kBf16Tolerance = 0.025;

inline double tolerance_of(const Model& model) {
  return model.config.encoding == FeatureEncoding::hash_grid ? kHashGridTolerance : kTolerance;
}

inline std::vector<float> answers(const Backend& backend, const Model& model, const OwnedBatch& batch,
                                  const QueryOptions& options) {
  std::vector<float> out(batch.size() * model.config.mlp.outputs, -7.0f);
  backend.query(batch.points(), options, out);
  return out;
}

inline std::vector<float> raw_answers(const Backend& backend, const Model& model, const OwnedBatch& batch,
                                      bool averaged = true, QueryPrecision precision = QueryPrecision::fp32) {
  return answers(backend, model, batch, {precision, OutputRange::raw, averaged});
}

struct NamedBackend {
  std::string name;
  std::unique_ptr<Backend> backend;
};

/// Compares all backends of one kind with the reference, and prints the worst differences at its end.
class Agreement {
 public:
  using Makers =
      std::function<std::vector<NamedBackend>(const std::shared_ptr<const Model>&, const TrainingOptions&)>;

  /// `asks_after_steps`: compares the answers after a step too.
  Agreement(Makers make, bool asks_after_steps)
      : make_(std::move(make)), asks_after_steps_(asks_after_steps) {}
  ~Agreement() { worst_.print(); }

  void expect_within(double tolerance, double difference, const char* what, const Model& model,
                     const std::string& backend, const std::string& where) {
    const bool hash = model.config.encoding == FeatureEncoding::hash_grid;
    worst_.meet(backend, fmt::format("{}{}", what, hash ? ", hash grid" : ""), difference, where);
    EXPECT_LE(difference, tolerance) << what << ", " << where;
  }

  void expect_same_answers(const ModelCase& c, const TrainingOptions& options, const OwnedBatch& batch,
                           const ModelState& state) {
    const auto reference = reference::make_reference_backend(c.model, options);
    reference->import_state(state);
    const std::string where = fmt::format("{}, {} points", c.name, batch.size());
    const std::array expected = both_answers(*reference, *c.model, batch);
    for (const auto& [name, fast] : make_(c.model, options)) {
      SCOPED_TRACE(fmt::format("{}: {}", name, where));
      fast->import_state(state);
      expect_answers(*fast, *c.model, batch, expected, "answers", name, where);
    }
  }

  void expect_same_step(const std::string& name, const std::shared_ptr<const Model>& model,
                        const TrainingOptions& options, const OwnedBatch& batch, const ModelState& state,
                        int steps = 1) {
    const auto reference = reference::make_reference_backend(model, options);
    reference->import_state(state);
    const Step expected = make_steps(*reference, *model, batch, steps, asks_after_steps_);
    EXPECT_EQ(expected.statistics.rejected, batch.count(Fate::rejected));
    EXPECT_EQ(expected.statistics.unstored, batch.count(Fate::unstored));
    const std::vector<bool> doubtful = doubtful_nodes(*model, batch);
    const std::string where = fmt::format("{}, {} records", name, batch.size());
    for (const auto& [backend, fast] : make_(model, options)) {
      SCOPED_TRACE(fmt::format("{}: {}", backend, where));
      fast->import_state(state);
      const Step got = make_steps(*fast, *model, batch, steps, false);
      const std::vector<bool> without = expect_same_counts(doubtful, got, expected);
      expect_same_state(*model, options, got, expected, without, backend, where);
      const bool exact = options.precision == FeaturePrecision::fp32 &&
                         std::count(without.begin(), without.end(), true) == 0;
      if (asks_after_steps_ && exact)
        expect_answers(*fast, *model, batch, expected.answers, "answers after a step", backend, where);
    }
  }

 private:
  /// Answers by the parameters and by their averages.
  using BothAnswers = std::array<std::vector<float>, 2>;

  struct Step {
    StepStatistics statistics;
    ModelState after;
    BothAnswers answers;
  };

  static BothAnswers both_answers(const Backend& backend, const Model& model, const OwnedBatch& batch) {
    return {raw_answers(backend, model, batch, false), raw_answers(backend, model, batch, true)};
  }

  static Step make_steps(Backend& backend, const Model& model, const OwnedBatch& batch, int steps,
                         bool asks) {
    Step step;
    for (int i = 0; i < steps; ++i) step.statistics = backend.train(batch.training());
    step.after = backend.export_state();
    if (asks) step.answers = both_answers(backend, model, batch);
    return step;
  }

  void expect_answers(const Backend& fast, const Model& model, const OwnedBatch& batch,
                      const BothAnswers& expected, const char* what, const std::string& backend,
                      const std::string& where) {
    for (const bool averaged : {false, true})
      expect_within(tolerance_of(model),
                    relative_difference(raw_answers(fast, model, batch, averaged), expected[averaged]), what,
                    model, backend, where);
  }

  /// Returns the nodes to leave out, where the last bit of a float decides whether they are touched.
  static std::vector<bool> expect_same_counts(const std::vector<bool>& doubtful, const Step& got,
                                              const Step& expected) {
    EXPECT_EQ(got.statistics.records, expected.statistics.records);
    EXPECT_EQ(got.statistics.rejected, expected.statistics.rejected);
    EXPECT_EQ(got.statistics.unstored, expected.statistics.unstored);
    EXPECT_EQ(got.statistics.clipped, expected.statistics.clipped);
    EXPECT_EQ(got.statistics.skipped_updates, expected.statistics.skipped_updates);
    EXPECT_NEAR(static_cast<double>(got.statistics.touched_nodes),
                static_cast<double>(expected.statistics.touched_nodes),
                static_cast<double>(std::count(doubtful.begin(), doubtful.end(), true)));
    EXPECT_EQ(got.after.steps, expected.after.steps);
    EXPECT_EQ(got.after.triangle_steps, expected.after.triangle_steps);
    std::vector<bool> without(doubtful.size(), false);
    for (std::size_t n = 0; n < got.after.node_steps.size(); ++n) {
      without[n] = got.after.node_steps[n] != expected.after.node_steps[n];
      EXPECT_TRUE(!without[n] || doubtful[n]) << "node " << n << ": " << got.after.node_steps[n]
                                              << " steps, expected " << expected.after.node_steps[n];
    }
    return without;
  }

  void expect_same_state(const Model& model, const TrainingOptions& options, const Step& got,
                         const Step& expected, const std::vector<bool>& without, const std::string& backend,
                         const std::string& where) {
    const double tolerance = tolerance_of(model);
    const auto check = [&](const char* what, const std::vector<float>& a, const std::vector<float>& b,
                           double times = 1) {
      expect_within(times * tolerance, tensor_difference(model, a, b, without), what, model, backend, where);
    };
    const double loss = expected.statistics.loss;
    expect_within(tolerance, std::abs(got.statistics.loss - loss) / std::max(loss, 1e-30), "loss", model,
                  backend, where);
    check("first moments", got.after.first_moments, expected.after.first_moments);
    check("second moments", got.after.second_moments, expected.after.second_moments, 2);
    if (options.precision == FeaturePrecision::fp16) {
      for (const auto& [a, b] : {std::pair{&got.after.parameters, &expected.after.parameters},
                                 {&got.after.averages, &expected.after.averages}}) {
        EXPECT_LE(tensor_difference(model, *a, *b, without), kHalfTolerance);
        EXPECT_LE(differing_share(model, *a, *b, tolerance), kHalfShare);
      }
      return;
    }
    check("parameters", got.after.parameters, expected.after.parameters);
    check("averages", got.after.averages, expected.after.averages);
  }

  Makers make_;
  bool asks_after_steps_;
  Worst worst_;
};

}  // namespace gatelight::neural::testing
