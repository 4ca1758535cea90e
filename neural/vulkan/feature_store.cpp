#include "neural/vulkan/feature_store.h"

#include <algorithm>
#include <bit>

#include "base/half.h"

namespace gatelight::neural::vulkan {

namespace {

std::span<const std::uint32_t> as_words(std::span<const float> values) {
  return {reinterpret_cast<const std::uint32_t*>(values.data()), values.size()};
}

std::span<std::uint32_t> as_words(std::span<float> values) {
  return {reinterpret_cast<std::uint32_t*>(values.data()), values.size()};
}

// A word has two halves; each node starts with a new word.
std::uint32_t half_stride(std::uint64_t features) {
  return static_cast<std::uint32_t>((features + 1) / 2);
}

std::vector<std::uint32_t> pack_halves(std::span<const float> values, std::uint64_t features) {
  if (features == 0) return {};
  const std::uint64_t stride = half_stride(features);
  std::vector<std::uint32_t> words(values.size() / features * stride, 0);
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    const std::uint64_t node = i / features, f = i % features;
    words[node * stride + f / 2] |= std::uint32_t{float_to_finite_half(values[i])} << (16 * (f % 2));
  }
  return words;
}

void unpack_halves(std::span<const std::uint32_t> words, std::uint64_t features, std::span<float> values) {
  const std::uint64_t stride = half_stride(features);
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    const std::uint64_t node = i / features, f = i % features;
    values[i] =
        half_to_float(static_cast<std::uint16_t>(words[node * stride + f / 2] >> (16 * (f % 2)) & 0xffffu));
  }
}

}  // namespace

std::uint64_t feature_bytes(const Model& model, const TrainingOptions& options) {
  const std::uint64_t features = model.parameters.features;
  const std::uint64_t floats = options.precision != FeaturePrecision::fp16 ? features : 0;
  const std::uint64_t halves = options.precision != FeaturePrecision::fp32 ? half_stride(features) : 0;
  const std::uint64_t copies = options.average.features ? 2 : 1;
  const std::uint64_t steps = options.update == FeatureUpdate::sparse ? 1 : 0;
  return 4 * (model.parameters.node_count * (copies * (floats + halves) + 2 * features + steps) +
              (options.counts_triangles() ? 2 * std::uint64_t{model.gate.triangle_count} : 0));
}

FeatureStore::FeatureStore(const Device& device, Transfer& transfer, const Model& model,
                           const TrainingOptions& options, std::uint64_t longest_part)
    : nodes_(model.parameters.node_count),
      features_per_node_(model.parameters.features),
      triangles_(model.gate.triangle_count) {
  const auto make = [&](std::uint64_t entries, std::uint64_t stride) {
    return Table(device, transfer, entries, static_cast<std::uint32_t>(stride), longest_part);
  };
  const std::uint64_t features = features_per_node_;
  const bool floats = options.precision != FeaturePrecision::fp16;
  const bool halves = options.precision != FeaturePrecision::fp32;
  if (floats) features_ = make(nodes_, features);
  if (halves) halves_ = make(nodes_, half_stride(features));
  if (options.average.features && floats) averages_ = make(nodes_, features);
  if (options.average.features && halves) average_halves_ = make(nodes_, half_stride(features));
  moments_ = make(nodes_, 2 * features);
  if (options.update == FeatureUpdate::sparse) node_steps_ = make(nodes_, 1);
  if (options.counts_triangles()) {
    triangle_steps_ = make(triangles_, 1);
    triangle_stamps_ = make(triangles_, 1);
  }
}

void FeatureStore::describe(ModelBlock& block) const {
  block.features = features_.block();
  block.halves = halves_.block();
  block.averages = averages_.block();
  block.average_halves = average_halves_.block();
  block.moments = moments_.block();
  block.node_steps = node_steps_.block();
  block.triangle_steps = triangle_steps_.block();
  block.triangle_stamps = triangle_stamps_.block();
}

TableBlock FeatureStore::readable(bool averaged) const {
  if (averaged && averages()) return halves() ? average_halves_.block() : averages_.block();
  return halves() ? halves_.block() : features_.block();
}

void FeatureStore::export_to(Transfer& transfer, ModelState& state) const {
  const std::uint64_t count = nodes_ * features_per_node_;
  const auto get = [&](const Table& as_floats, const Table& as_halves, std::span<float> values) {
    if (!as_floats.empty()) {
      as_floats.read(transfer, as_words(values));
      return;
    }
    std::vector<std::uint32_t> words(nodes_ * half_stride(features_per_node_));
    as_halves.read(transfer, words);
    unpack_halves(words, features_per_node_, values);
  };
  const std::span<float> parameters = std::span(state.parameters).first(count);
  const std::span<float> average = std::span(state.averages).first(count);
  get(features_, halves_, parameters);
  if (averages())
    get(averages_, average_halves_, average);
  else
    std::ranges::copy(parameters, average.begin());

  std::vector<std::uint32_t> moments(2 * count);
  moments_.read(transfer, moments);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t at = i / features_per_node_ * 2 * features_per_node_ + i % features_per_node_;
    state.first_moments[i] = std::bit_cast<float>(moments[at]);
    state.second_moments[i] = std::bit_cast<float>(moments[at + features_per_node_]);
  }
  state.node_steps.assign(node_steps_.empty() ? 0 : nodes_, 0);
  node_steps_.read(transfer, state.node_steps);
  state.triangle_steps.assign(triangle_steps_.empty() ? 0 : triangles_, 0);
  triangle_steps_.read(transfer, state.triangle_steps);
}

void FeatureStore::import_from(Transfer& transfer, const ModelState& state) {
  const std::uint64_t count = nodes_ * features_per_node_;
  const auto put = [&](Table& as_floats, Table& as_halves, std::span<const float> values) {
    if (!as_floats.empty()) as_floats.write(transfer, as_words(values));
    if (!as_halves.empty()) as_halves.write(transfer, pack_halves(values, features_per_node_));
  };
  put(features_, halves_, std::span(state.parameters).first(count));
  put(averages_, average_halves_, std::span(state.averages).first(count));
  std::vector<std::uint32_t> moments(2 * count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t at = i / features_per_node_ * 2 * features_per_node_ + i % features_per_node_;
    moments[at] = std::bit_cast<std::uint32_t>(state.first_moments[i]);
    moments[at + features_per_node_] = std::bit_cast<std::uint32_t>(state.second_moments[i]);
  }
  moments_.write(transfer, moments);
  node_steps_.write(transfer, state.node_steps);
  triangle_steps_.write(transfer, state.triangle_steps);
  triangle_stamps_.fill(transfer, 0);
}

std::uint64_t FeatureStore::parameter_bytes() const {
  return halves() ? halves_.bytes() : features_.bytes();
}

std::uint64_t FeatureStore::optimizer_bytes() const {
  return (halves() ? features_.bytes() : 0) + averages_.bytes() + average_halves_.bytes() + moments_.bytes() +
         node_steps_.bytes() + triangle_steps_.bytes() + triangle_stamps_.bytes();
}

}  // namespace gatelight::neural::vulkan
