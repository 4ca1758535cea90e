#pragma once
// Comparison of a fast backend with the reference: states, batches and differences.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "neural/cpu/cpu_backend.h"
#include "neural/learning/record_status.h"
#include "neural/reference/encode.h"
#include "neural/reference/mlp.h"
#include "neural/reference/reference_backend.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::testing {

// ---- states

/// Features of magnitude 0.5 instead of 1e-4, so that a wrong one shows, and biases. `trained`: with moments,
/// averages and counters as if after some steps, else as before the first.
inline ModelState random_state(const Model& model, const TrainingOptions& options, std::uint64_t seed,
                               bool trained) {
  TrainingOptions seeded = options;
  seeded.seed = seed;
  ModelState state = initial_state(model, seeded);
  Random random{seed ^ 0x5eed};
  const ParameterLayout& layout = model.parameters;
  for (std::uint64_t p = 0; p < layout.network; ++p) state.parameters[p] = random.between(-0.5f, 0.5f);
  for (const LayerLayout& layer : layout.layers)
    for (std::uint32_t o = 0; layout.biases && o < layer.outputs; ++o)
      state.parameters[layer.biases + o] = random.between(-0.2f, 0.2f);
  // Away from a luminance of 0, where the relative loss magnifies rounding errors.
  for (std::uint32_t o = 0; layout.biases && o < layout.layers.back().outputs; ++o)
    state.parameters[layout.layers.back().biases + o] += 2.0f;
  state.averages = state.parameters;
  if (!trained) return state;
  for (std::uint64_t p = 0; p < layout.count; ++p) {
    const bool averaged = p < layout.network ? options.average.features : options.average.network;
    if (averaged) state.averages[p] += random.between(-0.1f, 0.1f);
    state.first_moments[p] = random.between(-0.02f, 0.02f);
    state.second_moments[p] = random.between(0.0f, 1e-3f);
  }
  for (std::uint32_t& steps : state.node_steps) steps = random.below(9);
  for (std::uint32_t& steps : state.triangle_steps) steps = random.below(9);
  state.steps = 8;
  return state;
}

/// Adam with a learning rate and an epsilon that make a step a smooth function of the gradient. (With the
/// default 1e-15 the first step is the gradient's sign, whatever its size.)
inline void make_smooth(AdamOptions& adam) {
  adam.learning_rate = 1.0f;
  adam.epsilon = 1.0f;
}

/// A step is a smooth function of the gradient, and the first batch does not move the output's bias.
inline TrainingOptions smooth_options() {
  TrainingOptions options;
  make_smooth(options.adam);
  options.start_at_mean = false;  // it would put targets near answers (make_smooth_batch)
  return options;
}

// ---- batches

/// A record whose gradient jumps within a rounding error: some hidden unit is about to change its side.
inline bool is_near_kink(const Model& model, std::span<const double> parameters,
                         const reference::Point& point) {
  const reference::Activations layers =
      reference::forward(model, parameters, reference::encode(model, parameters, point));
  const double slope = model.config.mlp.leaky_slope;
  for (std::size_t l = 1; l + 1 < layers.size(); ++l) {
    double greatest = 0;
    for (const double x : layers[l]) greatest = std::max(greatest, std::abs(x));
    for (const double x : layers[l]) {
      const double before = x < 0 ? -x / slope : x;
      if (before < 3e-6 * greatest && (slope > 0 || x > 0)) return true;
    }
  }
  return false;
}

inline std::vector<double> widen(const std::vector<float>& values) {
  return {values.begin(), values.end()};
}

/// A batch whose records near a kink of this state have become ones to reject. Targets are moved away from
/// the answers, as their difference would lose the digits that both have in common.
inline OwnedBatch make_smooth_batch(const Model& model, const ModelState& state, std::size_t size,
                                    std::uint64_t seed, const BatchOptions& options) {
  const std::vector<double> parameters = widen(state.parameters);
  OwnedBatch batch = make_batch(model, size, seed, options);
  for (float& target : batch.targets) target += 5.0f;
  for (std::size_t r = 0; r < size; ++r)
    if (record_status(model, batch.training(), r) == RecordStatus::accepted &&
        is_near_kink(model, parameters, reference::read_point(model, batch.points(), r))) {
      batch.targets[r * model.config.mlp.outputs] = std::numeric_limits<float>::quiet_NaN();
      batch.fates[r] = Fate::rejected;
    }
  return batch;
}

/// Nodes that no accepted record reads with a weight that is surely not 0: the last bit decides whether a
/// step touches them.
inline std::vector<bool> doubtful_nodes(const Model& model, const OwnedBatch& batch) {
  std::vector<bool> read(model.parameters.node_count, false), sure = read;
  for (std::size_t r = 0; r < batch.size(); ++r) {
    if (record_status(model, batch.training(), r) != RecordStatus::accepted) continue;
    for (const auto& [node, weight] :
         reference::encoding_nodes(model, reference::read_point(model, batch.points(), r))) {
      read[node] = true;
      if (weight > 1e-4) sure[node] = true;
    }
  }
  for (std::size_t n = 0; n < read.size(); ++n) read[n] = read[n] && !sure[n];
  return read;
}

// ---- differences

/// The greatest |a - b| over the greatest |b|; infinite where one is not finite and the other is not the
/// same.
inline double relative_difference(std::span<const float> a, std::span<const float> b) {
  double difference = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) {
      if (a[i] != b[i]) return std::numeric_limits<double>::infinity();
      continue;
    }
    difference = std::max(difference, std::abs(static_cast<double>(a[i]) - b[i]));
    scale = std::max(scale, std::abs(static_cast<double>(b[i])));
  }
  return difference == 0 ? 0 : difference / scale;
}

/// The same for each tensor (features, each layer's weights, each layer's biases); the greatest of all.
/// Features of nodes in `without` are left out.
inline double tensor_difference(const Model& model, const std::vector<float>& a, const std::vector<float>& b,
                                const std::vector<bool>& without) {
  const ParameterLayout& layout = model.parameters;
  std::vector<float> x, y;
  for (std::uint64_t p = 0; p < layout.network; ++p) {
    if (without[p / layout.features]) continue;
    x.push_back(a[p]);
    y.push_back(b[p]);
  }
  double worst = relative_difference(x, y);
  const auto part = [&](std::uint64_t begin, std::uint64_t end) {
    const auto of = [&](const std::vector<float>& v) { return std::span(v).subspan(begin, end - begin); };
    worst = std::max(worst, relative_difference(of(a), of(b)));
  };
  for (const LayerLayout& layer : layout.layers) {
    part(layer.weights, layer.biases);
    if (layout.biases) part(layer.biases, layer.biases + layer.outputs);
  }
  return worst;
}

/// The share of features that differ by more than `tolerance` times the greatest.
inline double differing_share(const Model& model, const std::vector<float>& a, const std::vector<float>& b,
                              double tolerance) {
  const std::span x = std::span(a).first(model.parameters.network);
  const std::span y = std::span(b).first(model.parameters.network);
  double scale = 0;
  for (const float value : y) scale = std::max(scale, std::abs(static_cast<double>(value)));
  std::size_t differing = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::abs(static_cast<double>(x[i]) - y[i]) > tolerance * scale) ++differing;
  return x.empty() ? 0 : static_cast<double>(differing) / static_cast<double>(x.size());
}

/// Answers of three outputs without a range, and the same within their ranges. Some are below zero, some
/// above one, some of points that are no numbers.
inline void expect_ranges(const Model& model, const OwnedBatch& batch, std::span<const float> raw,
                          std::span<const float> positive, std::span<const float> unit) {
  std::size_t below = 0, above = 0, nan = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const bool usable = std::isfinite(raw[i]);
    EXPECT_EQ(usable, is_finite(model, batch.points(), i / 3));
    EXPECT_EQ(positive[i], usable ? std::max(raw[i], 0.0f) : 0.0f);
    EXPECT_EQ(unit[i], usable ? std::clamp(raw[i], 0.0f, 1.0f) : 0.0f);
    below += raw[i] < 0 ? 1 : 0;
    above += raw[i] > 1 ? 1 : 0;
    nan += usable ? 0 : 1;
  }
  EXPECT_GT(below, 0u);
  EXPECT_GT(above, 0u);
  EXPECT_GT(nan, 0u);
}

/// The worst difference of each kind, for each instruction set, and the case where it was met.
class Worst {
 public:
  void meet(std::string_view isa, const std::string& kind, double value, const std::string& where) {
    auto& [worst, place] = values_[kind][std::string(isa)];
    if (value >= worst) {
      worst = value;
      place = where;
    }
  }
  void print() const {
    for (const auto& [kind, by_isa] : values_)
      for (const auto& [isa, worst] : by_isa)
        fmt::print("[ measured ] {:32} {:7} {:.1e}  {}\n", kind, isa, worst.first, worst.second);
  }

 private:
  std::map<std::string, std::map<std::string, std::pair<double, std::string>>> values_;
};

}  // namespace gatelight::neural::testing
