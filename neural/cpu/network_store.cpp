#include "neural/cpu/network_store.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "neural/cpu/adam_table.h"

namespace gatelight::neural::cpu {

NetworkStore::NetworkStore(const Model& model, const TrainingOptions& options)
    : layout_(model.parameters), options_(options), raw_(model), averaged_(model) {
  arrays_.parameters = initial_network(model, options_);
  arrays_.averages = arrays_.parameters;
  arrays_.first_moments.assign(arrays_.parameters.size(), 0.0f);
  arrays_.second_moments.assign(arrays_.parameters.size(), 0.0f);
  raw_.pack(arrays_.parameters);
}

const KernelNetwork& NetworkStore::query_kernel(bool averaged) const {
  if (!averaged || !options_.average.network) return raw_.kernel();
  if (!averaged_packed_) {
    averaged_.pack(arrays_.averages);
    averaged_packed_ = true;
  }
  return averaged_.kernel();
}

void NetworkStore::set_output_biases(std::span<const double> values) {
  float* biases = arrays_.parameters.data() + (layout_.layers.back().biases - layout_.network);
  for (std::size_t c = 0; c < values.size(); ++c) biases[c] = static_cast<float>(values[c]);
  raw_.pack(arrays_.parameters);
}

std::uint64_t NetworkStore::update(const float* packed_gradients, float scale, std::uint64_t step) {
  std::vector<float>& parameters = arrays_.parameters;
  std::vector<float>& averages = arrays_.averages;
  std::vector<float>& first = arrays_.first_moments;
  std::vector<float>& second = arrays_.second_moments;
  gradients_.resize(parameters.size());
  raw_.unpack_gradients(packed_gradients, gradients_);
  const KernelAdamStep adam = adam_step(options_, step);
  const float beta1 = options_.adam.beta1, beta2 = options_.adam.beta2;
  std::uint64_t skipped = 0;
  const auto update_from = [&](std::uint64_t begin, std::uint64_t end, float l2) {
    for (std::uint64_t i = begin - layout_.network; i < end - layout_.network; ++i) {
      const float g = gradients_[i] * scale + l2 * parameters[i];
      if (!std::isfinite(g * g)) {
        ++skipped;
        continue;
      }
      first[i] = beta1 * first[i] + (1.0f - beta1) * g;
      second[i] = beta2 * second[i] + (1.0f - beta2) * g * g;
      parameters[i] -= adam.step * first[i] / (std::sqrt(second[i]) + adam.epsilon);
      if (options_.average.network) averages[i] += adam.average_rate * (parameters[i] - averages[i]);
    }
  };
  for (const LayerLayout& layer : layout_.layers) {
    update_from(layer.weights, layer.biases, options_.adam.l2_network);
    if (layout_.biases) update_from(layer.biases, layer.biases + layer.outputs, 0.0f);
  }
  raw_.pack(parameters);
  averaged_packed_ = false;
  return skipped;
}

void NetworkStore::export_to(ModelState& state) const {
  const auto put = [&](std::vector<float>& to, const std::vector<float>& from) {
    to.resize(layout_.count);
    std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(layout_.network));
  };
  put(state.parameters, arrays_.parameters);
  put(state.averages, options_.average.network ? arrays_.averages : arrays_.parameters);
  put(state.first_moments, arrays_.first_moments);
  put(state.second_moments, arrays_.second_moments);
}

NetworkStore::Arrays NetworkStore::arrays_of(const ModelState& state) const {
  const auto take = [&](const std::vector<float>& from) {
    return std::vector<float>(from.begin() + static_cast<std::ptrdiff_t>(layout_.network), from.end());
  };
  return {take(state.parameters), take(state.averages), take(state.first_moments),
          take(state.second_moments)};
}

void NetworkStore::set(Arrays arrays) {
  arrays_ = std::move(arrays);
  raw_.pack(arrays_.parameters);
  averaged_packed_ = false;
}

}  // namespace gatelight::neural::cpu
