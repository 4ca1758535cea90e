#pragma once
// Checks that the Vulkan backend agrees with the reference.

#include <gtest/gtest.h>

#include <array>

#include "tests/neural/vulkan/device.h"
#include "tests/support/parity.h"

namespace gatelight::neural::testing {

// The tolerances of the CPU's kernels (kernel_parity_test.cpp), which add in another order.
inline constexpr double kVulkanTolerance = 3e-5;
inline constexpr double kVulkanHashGridTolerance = 5e-5;
inline constexpr double kVulkanHalfTolerance = 0x1p-9;
inline constexpr double kVulkanHalfShare = 0.02;

class Agreement {
 public:
  ~Agreement() { worst_.print(); }

  void expect_within(double tolerance, double difference, const char* what, const Model& model,
                     const std::string& where) {
    const bool hash = model.config.encoding == FeatureEncoding::hash_grid;
    worst_.meet("vulkan", fmt::format("{}{}", what, hash ? ", hash grid" : ""), difference, where);
    EXPECT_LE(difference, tolerance) << what << ", " << where;
  }

  static double tolerance_of(const Model& model) {
    return model.config.encoding == FeatureEncoding::hash_grid ? kVulkanHashGridTolerance : kVulkanTolerance;
  }

  static std::vector<float> answers(const Backend& backend, const Model& model, const OwnedBatch& batch,
                                    const QueryOptions& options) {
    std::vector<float> out(batch.size() * model.config.mlp.outputs, -7.0f);
    backend.query(batch.points(), options, out);
    return out;
  }

  void expect_same_answers(const ModelCase& c, const TrainingOptions& options, const OwnedBatch& batch,
                           const ModelState& state) {
    const auto reference = reference::make_reference_backend(c.model, options);
    const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, options);
    reference->import_state(state);
    device->import_state(state);
    for (const bool averaged : {false, true}) {
      const QueryOptions raw{QueryPrecision::fp32, OutputRange::raw, averaged};
      expect_within(tolerance_of(*c.model),
                    relative_difference(answers(*device, *c.model, batch, raw),
                                        answers(*reference, *c.model, batch, raw)),
                    "answers", *c.model, fmt::format("{}, {} points", c.name, batch.size()));
    }
  }

  void expect_same_step(const std::string& name, const std::shared_ptr<const Model>& model,
                        const TrainingOptions& options, const OwnedBatch& batch, const ModelState& state) {
    const std::string where = fmt::format("{}, {} records", name, batch.size());
    SCOPED_TRACE(where);
    const auto reference = reference::make_reference_backend(model, options);
    const auto device = vulkan::make_vulkan_backend(test_machine(), model, options);
    reference->import_state(state);
    device->import_state(state);
    const StepStatistics expected = reference->train(batch.training());
    const StepStatistics statistics = device->train(batch.training());
    const ModelState after = reference->export_state(), got = device->export_state();
    const std::vector<bool> without = expect_same_counts(*model, batch, expected, statistics, after, got);
    const double tolerance = tolerance_of(*model);
    const auto check = [&](const char* what, const std::vector<float>& a, const std::vector<float>& b,
                           double times = 1) {
      expect_within(times * tolerance, tensor_difference(*model, a, b, without), what, *model, where);
    };
    expect_within(tolerance, std::abs(statistics.loss - expected.loss) / std::max(expected.loss, 1e-30),
                  "loss", *model, where);
    check("first moments", got.first_moments, after.first_moments);
    check("second moments", got.second_moments, after.second_moments, 2);
    if (options.precision == FeaturePrecision::fp16) {
      for (const auto& [a, b] :
           {std::pair{&got.parameters, &after.parameters}, {&got.averages, &after.averages}}) {
        EXPECT_LE(tensor_difference(*model, *a, *b, without), kVulkanHalfTolerance);
        EXPECT_LE(differing_share(*model, *a, *b, tolerance), kVulkanHalfShare);
      }
      return;
    }
    check("parameters", got.parameters, after.parameters);
    check("averages", got.averages, after.averages);
  }

 private:
  /// Returns the nodes to leave out, where the last bit of a float decides whether they are touched.
  static std::vector<bool> expect_same_counts(const Model& model, const OwnedBatch& batch,
                                              const StepStatistics& expected,
                                              const StepStatistics& statistics, const ModelState& after,
                                              const ModelState& got) {
    const std::vector<bool> doubtful = doubtful_nodes(model, batch);
    EXPECT_EQ(statistics.records, expected.records);
    EXPECT_EQ(statistics.rejected, expected.rejected);
    EXPECT_EQ(statistics.unstored, expected.unstored);
    EXPECT_EQ(statistics.clipped, expected.clipped);
    EXPECT_EQ(statistics.skipped_updates, expected.skipped_updates);
    EXPECT_NEAR(static_cast<double>(statistics.touched_nodes), static_cast<double>(expected.touched_nodes),
                static_cast<double>(std::count(doubtful.begin(), doubtful.end(), true)));
    EXPECT_EQ(got.steps, after.steps);
    EXPECT_EQ(got.triangle_steps, after.triangle_steps);
    std::vector<bool> without(model.parameters.node_count, false);
    for (std::size_t n = 0; n < got.node_steps.size(); ++n) {
      without[n] = got.node_steps[n] != after.node_steps[n];
      EXPECT_TRUE(!without[n] || doubtful[n])
          << "node " << n << ": " << got.node_steps[n] << " steps, expected " << after.node_steps[n];
    }
    return without;
  }

  Worst worst_;
};

inline TrainingOptions smooth_options() {
  TrainingOptions options;
  make_smooth(options.adam);
  options.start_at_mean = false;  // it would put targets near answers (make_smooth_batch)
  return options;
}

}  // namespace gatelight::neural::testing
