#pragma once
// A backend that does not train: it stores a state, for tests of the code around a backend.

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "base/half.h"
#include "base/random.h"
#include "neural/model/backend.h"
#include "neural/model/checks.h"

namespace gatelight::neural::testing {

class StoredState final : public Backend {
 public:
  StoredState(std::shared_ptr<const Model> model, const TrainingOptions& options, ModelState state)
      : model_(std::move(model)), options_(options), state_(std::move(state)) {}

  StepStatistics train(const TrainingBatch& batch) override {
    ++state_.steps;
    StepStatistics statistics;
    statistics.records = batch.points.size;
    return statistics;
  }
  void query(const QueryBatch&, const QueryOptions&, std::span<float> out) const override {
    for (float& value : out) value = static_cast<float>(state_.steps);
  }
  ModelState export_state() const override { return state_; }
  void import_state(const ModelState& state) override {
    check_state(*model_, options_, state);
    state_ = state;
  }
  std::string name() const override { return "held"; }
  std::uint64_t parameter_bytes() const override { return 0; }
  std::uint64_t optimizer_bytes() const override { return 0; }

 private:
  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  ModelState state_;
};

/// Any finite float, denormals and -0 among them.
inline float any_float(std::uint64_t seed, std::uint64_t i) {
  const auto bits = static_cast<std::uint32_t>(mix_bits(mix_bits(seed) ^ i));
  if (i % 17 == 3) return -0.0f;
  const float value = std::bit_cast<float>(bits);
  return std::isfinite(value) ? value : std::bit_cast<float>(bits & 0x807fffffu);
}

/// Any finite number of fp16.
inline float any_half(std::uint64_t seed, std::uint64_t i) {
  const auto bits = static_cast<std::uint16_t>(mix_bits(mix_bits(seed) ^ i));
  return half_to_float((bits & 0x7c00u) == 0x7c00u ? static_cast<std::uint16_t>(bits & 0x83ffu) : bits);
}

/// A state of all kinds of numbers that is one the model and options can have.
inline ModelState any_state(const Model& model, const TrainingOptions& options, std::uint64_t seed) {
  ModelState state = initial_state(model, options);
  const std::uint64_t network = model.parameters.network;
  for (std::uint64_t i = 0; i < model.parameters.count; ++i) {
    const bool feature = i < network;
    state.parameters[i] =
        feature && options.precision == FeaturePrecision::fp16 ? any_half(seed, i) : any_float(seed, i);
    const bool averaged = feature ? options.average.features : options.average.network;
    state.averages[i] = averaged ? any_float(seed + 1, i) : state.parameters[i];
    state.first_moments[i] = any_float(seed + 2, i);
    state.second_moments[i] = std::abs(any_float(seed + 3, i));
  }
  std::uint64_t i = 0;
  for (std::uint32_t& steps : state.node_steps) steps = static_cast<std::uint32_t>(mix_bits(seed + ++i));
  for (std::uint32_t& steps : state.triangle_steps) steps = static_cast<std::uint32_t>(mix_bits(seed + ++i));
  state.steps = mix_bits(seed) >> 1;
  return state;
}

/// Equal to the bit: unlike ==, which takes -0 for 0.
inline bool same_bits(const ModelState& a, const ModelState& b) {
  const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0);
  };
  return same(a.parameters, b.parameters) && same(a.averages, b.averages) &&
         same(a.first_moments, b.first_moments) && same(a.second_moments, b.second_moments) &&
         a.node_steps == b.node_steps && a.triangle_steps == b.triangle_steps && a.steps == b.steps;
}

}  // namespace gatelight::neural::testing
