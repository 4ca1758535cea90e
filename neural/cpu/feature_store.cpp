#include "neural/cpu/feature_store.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "neural/half.h"

namespace gatelight::neural::cpu {

namespace {

template <class F>
void for_range(std::uint64_t count, F&& body) {
  tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, count, 65536), [&](const auto& range) {
    for (std::uint64_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

// Where the features are stored; one element stands in where there are none, so that lookups may read node 0.
std::uint64_t at_least_one_node(std::uint64_t count, std::uint32_t features) {
  return std::max<std::uint64_t>(count, features);
}

}  // namespace

FeatureStore::FeatureStore(const Model& model, const TrainingOptions& options)
    : count_(model.parameters.network),
      all_count_(model.parameters.count),
      features_(model.parameters.features),
      precision_(options.precision),
      nodes_(model.parameters.node_count),
      averaging_(options.average.features),
      sparse_(options.update == FeatureUpdate::sparse) {
  const std::uint64_t size = at_least_one_node(count_, features_);
  const bool half = precision_ != FeaturePrecision::fp32;
  const bool floats = precision_ != FeaturePrecision::fp16;
  if (floats) floats_ = HugeBuffer<float>(size);
  if (half) halves_ = HugeBuffer<std::uint16_t>(size);
  if (averaging_ && floats) averages_ = HugeBuffer<float>(size);
  if (averaging_ && half) average_halves_ = HugeBuffer<std::uint16_t>(size);
  moments_ = HugeBuffer<float>(2 * size);
  if (sparse_) steps_ = HugeBuffer<std::uint32_t>(std::max(nodes_, 1u));
}

void FeatureStore::set_training_view(KernelEncoder& encoder) const {
  encoder.float_features = floats_.data();
  encoder.half_features = halves_.empty() ? nullptr : halves_.data();
}

void FeatureStore::set_query_view(KernelEncoder& encoder, bool averaged) const {
  if (!averaged || !averaging_) return set_training_view(encoder);
  encoder.float_features = averages_.data();
  encoder.half_features = average_halves_.empty() ? nullptr : average_halves_.data();
}

void FeatureStore::set_update_view(KernelFeatureUpdate& update) const {
  update.features_fp32 = floats_.data();
  update.features_fp16 = halves_.data();
  update.averages = averages_.data();
  update.averages_fp16 = average_halves_.data();
  update.moments = moments_.data();
  update.node_steps = steps_.data();
}

void FeatureStore::export_to(ModelState& state) const {
  state.parameters.resize(all_count_);
  state.averages.resize(all_count_);
  state.first_moments.resize(all_count_);
  state.second_moments.resize(all_count_);
  for_range(count_, [&](std::uint64_t i) {
    const float p = floats_.empty() ? half_to_float(halves_[i]) : floats_[i];
    state.parameters[i] = p;
    state.averages[i] = !averaging_         ? p
                        : averages_.empty() ? half_to_float(average_halves_[i])
                                            : averages_[i];
    const std::uint64_t moment = i / features_ * 2 * features_ + i % features_;
    state.first_moments[i] = moments_[moment];
    state.second_moments[i] = moments_[moment + features_];
  });
  state.node_steps.assign(steps_.data(), steps_.data() + (sparse_ ? nodes_ : 0));
}

void FeatureStore::import_from(const ModelState& state) {
  for_range(count_, [&](std::uint64_t i) {
    if (!floats_.empty()) floats_[i] = state.parameters[i];
    if (!halves_.empty()) halves_[i] = float_to_finite_half(state.parameters[i]);
    if (!averages_.empty()) averages_[i] = state.averages[i];
    if (!average_halves_.empty()) average_halves_[i] = float_to_finite_half(state.averages[i]);
    const std::uint64_t moment = i / features_ * 2 * features_ + i % features_;
    moments_[moment] = state.first_moments[i];
    moments_[moment + features_] = state.second_moments[i];
  });
  if (sparse_) std::copy(state.node_steps.begin(), state.node_steps.end(), steps_.data());
}

std::uint64_t FeatureStore::parameter_bytes() const {
  return count_ * (precision_ == FeaturePrecision::fp32 ? 4 : 2);
}

std::uint64_t FeatureStore::optimizer_bytes() const {
  const std::uint64_t masters = precision_ == FeaturePrecision::fp16_masters ? floats_.bytes() : 0;
  return masters + averages_.bytes() + average_halves_.bytes() + moments_.bytes() + steps_.bytes();
}

}  // namespace gatelight::neural::cpu
