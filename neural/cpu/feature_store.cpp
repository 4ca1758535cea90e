#include "neural/cpu/feature_store.h"

#include <algorithm>
#include <bit>

#include "base/half.h"
#include "base/parallel/loops.h"

namespace gatelight::neural::cpu {

namespace {

template <class F>
void for_range(std::uint64_t count, F&& body) {
  for_each_range(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

constexpr std::uint32_t kLineFloats = 16;

}  // namespace

FeatureStore::FeatureStore(const Model& model, const TrainingOptions& options)
    : count_(model.parameters.network),
      all_count_(model.parameters.count),
      features_(model.parameters.features),
      precision_(options.precision),
      nodes_(model.parameters.node_count),
      averaging_(options.average.features),
      sparse_(options.update == FeatureUpdate::sparse) {
  const bool half = precision_ != FeaturePrecision::fp32;
  const bool floats = precision_ != FeaturePrecision::fp16;
  const bool beside = averaging_ && 2 * features_ <= kLineFloats;
  feature_stride_ = beside ? 2 * features_ : features_;
  if (floats) floats_ = HugeBuffer<float>(floats_of(feature_stride_));
  if (half) halves_ = HugeBuffer<std::uint16_t>(floats_of(feature_stride_));
  if (beside) {
    if (floats) averages_ = floats_.data() + features_;
    if (half) average_halves_ = halves_.data() + features_;
  } else if (averaging_) {
    if (floats) separate_averages_ = HugeBuffer<float>(floats_of(features_));
    if (half) separate_average_halves_ = HugeBuffer<std::uint16_t>(floats_of(features_));
    averages_ = separate_averages_.data();
    average_halves_ = separate_average_halves_.data();
  }

  const std::uint32_t with_step = 2 * features_ + 1;
  const bool behind = sparse_ && with_step <= kLineFloats;
  moment_stride_ = behind ? std::bit_ceil(with_step) : 2 * features_;
  moments_ = HugeBuffer<float>(floats_of(moment_stride_));
  if (behind) {
    steps_ = reinterpret_cast<std::uint32_t*>(moments_.data() + 2 * features_);
    step_stride_ = moment_stride_;
  } else if (sparse_) {
    separate_steps_ = HugeBuffer<std::uint32_t>(floats_of(1));
    steps_ = separate_steps_.data();
  }

  for_range(nodes_, [&](std::uint64_t node) {
    for (std::uint32_t f = 0; f < features_; ++f) {
      const float feature = initial_feature(options, node * features_ + f);
      const float held = half ? half_to_float(float_to_half(feature)) : feature;
      set(node * feature_stride_ + f, held, held);
    }
  });
}

void FeatureStore::set(std::uint64_t at, float feature, float average) {
  if (!floats_.empty()) floats_[at] = feature;
  if (!halves_.empty()) halves_[at] = float_to_finite_half(feature);
  if (averages_ != nullptr) averages_[at] = average;
  if (average_halves_ != nullptr) average_halves_[at] = float_to_finite_half(average);
}

// Without nodes one is allocated, because lookups may read node 0.
std::uint64_t FeatureStore::floats_of(std::uint64_t per_node) const {
  return std::max(nodes_, 1u) * std::max<std::uint64_t>(per_node, 1);
}

void FeatureStore::set_training_view(KernelEncoder& encoder) const {
  encoder.feature_stride = feature_stride_;
  encoder.float_features = floats_.data();
  encoder.half_features = halves_.data();
}

void FeatureStore::set_query_view(KernelEncoder& encoder, bool averaged) const {
  set_training_view(encoder);
  if (!averaged || !averaging_) return;
  encoder.float_features = averages_;
  encoder.half_features = average_halves_;
}

void FeatureStore::set_update_view(KernelFeatureUpdate& update) const {
  update.feature_stride = feature_stride_;
  update.moment_stride = moment_stride_;
  update.step_stride = step_stride_;
  update.features_fp32 = floats_.data();
  update.features_fp16 = halves_.data();
  update.averages = averages_;
  update.averages_fp16 = average_halves_;
  update.moments = moments_.data();
  update.node_steps = steps_;
}

void FeatureStore::export_to(ModelState& state) const {
  state.parameters.resize(all_count_);
  state.averages.resize(all_count_);
  state.first_moments.resize(all_count_);
  state.second_moments.resize(all_count_);
  state.node_steps.assign(sparse_ ? nodes_ : 0, 0);
  for_range(nodes_, [&](std::uint64_t node) {
    const float* m = moments_.data() + node * moment_stride_;
    for (std::uint32_t f = 0; f < features_; ++f) {
      const std::uint64_t from = node * feature_stride_ + f, to = node * features_ + f;
      const float p = floats_.empty() ? half_to_float(halves_[from]) : floats_[from];
      state.parameters[to] = p;
      state.averages[to] = averages_ != nullptr         ? averages_[from]
                           : average_halves_ != nullptr ? half_to_float(average_halves_[from])
                                                        : p;
      state.first_moments[to] = m[f];
      state.second_moments[to] = m[f + features_];
    }
    if (sparse_) state.node_steps[node] = steps_[node * step_stride_];
  });
}

void FeatureStore::import_from(const ModelState& state) {
  for_range(nodes_, [&](std::uint64_t node) {
    float* m = moments_.data() + node * moment_stride_;
    for (std::uint32_t f = 0; f < features_; ++f) {
      const std::uint64_t from = node * features_ + f;
      set(node * feature_stride_ + f, state.parameters[from], state.averages[from]);
      m[f] = state.first_moments[from];
      m[f + features_] = state.second_moments[from];
    }
    if (sparse_) steps_[node * step_stride_] = state.node_steps[node];
  });
}

std::uint64_t FeatureStore::parameter_bytes() const {
  return count_ * (precision_ == FeaturePrecision::fp32 ? 4 : 2);
}

std::uint64_t FeatureStore::optimizer_bytes() const {
  const std::uint64_t all = floats_.bytes() + halves_.bytes() + separate_averages_.bytes() +
                            separate_average_halves_.bytes() + moments_.bytes() + separate_steps_.bytes();
  return all - parameter_bytes();
}

}  // namespace gatelight::neural::cpu
