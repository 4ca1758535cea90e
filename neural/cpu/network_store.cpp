#include "neural/cpu/network_store.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural::cpu {

namespace {

NetworkStore::Arrays new_arrays(std::uint64_t size) {
  return {HugeBuffer<float>(size), HugeBuffer<float>(size), HugeBuffer<float>(size), HugeBuffer<float>(size)};
}

}  // namespace

NetworkStore::NetworkStore(const Model& model, const TrainingOptions& options)
    : parameters_(model.parameters),
      options_(options),
      layout_(model),
      arrays_(new_arrays(layout_.size())),
      raw_(layout_, arrays_.parameters.data()),
      averaged_(layout_, arrays_.averages.data()) {
  const std::vector<float> initial = initial_network(model, options_);
  layout_.pack(initial, arrays_.parameters.data());
  layout_.pack(initial, arrays_.averages.data());
  raw_.update();
}

const KernelNetwork& NetworkStore::query_kernel(bool averaged, bool rounded) const {
  const bool of_averages = averaged && options_.average.network;
  PackedNetwork& network = of_averages ? averaged_ : raw_;
  std::atomic<bool>& ready = rounded ? rounded_ready_[of_averages ? 1 : 0] : averaged_ready_;
  if (ready.load(std::memory_order_acquire) || (!rounded && !of_averages)) return network.kernel();
  const std::lock_guard lock(mutex_);
  if (of_averages && !averaged_ready_) averaged_.update();
  if (of_averages) averaged_ready_ = true;
  if (rounded && !ready) network.update_rounded();
  ready = true;
  return network.kernel();
}

void NetworkStore::updated() {
  averaged_ready_ = false;
  for (std::atomic<bool>& ready : rounded_ready_) ready = false;
}

void NetworkStore::set_output_biases(std::span<const double> values) {
  float* const biases = raw_.kernel().layers[raw_.kernel().layer_count - 1].biases;
  for (std::size_t c = 0; c < values.size(); ++c) biases[c] = static_cast<float>(values[c]);
  updated();
}

std::uint64_t NetworkStore::update(std::uint64_t begin, std::uint64_t end, const float* gradients,
                                   std::uint32_t count, float scale, const KernelAdamStep& adam) {
  constexpr std::uint64_t kTogether = 64;
  float* const parameters = arrays_.parameters.data();
  float* const averages = arrays_.averages.data();
  float* const first = arrays_.first_moments.data();
  float* const second = arrays_.second_moments.data();
  const float beta1 = options_.adam.beta1, beta2 = options_.adam.beta2;
  std::uint64_t skipped = 0;
  const auto step = [&](std::uint64_t from, std::uint64_t to, float l2) {
    for (; from < to; from += kTogether) {
      const std::uint64_t size = std::min(kTogether, to - from);
      float sums[kTogether] = {};
      for (std::uint32_t c = 0; c < count; ++c) {
        const float* const g = gradients + c * layout_.size() + from;
        for (std::uint64_t i = 0; i < size; ++i) sums[i] += g[i];
      }
      for (std::uint64_t i = 0; i < size; ++i) {
        const std::uint64_t at = from + i;
        const float g = sums[i] * scale + l2 * parameters[at];
        if (!std::isfinite(g * g)) {
          ++skipped;
          continue;
        }
        first[at] = beta1 * first[at] + (1.0f - beta1) * g;
        second[at] = beta2 * second[at] + (1.0f - beta2) * g * g;
        parameters[at] -= adam.step * first[at] / (std::sqrt(second[at]) + adam.epsilon);
        if (options_.average.network) averages[at] += adam.average_rate * (parameters[at] - averages[at]);
      }
    }
  };
  for (std::uint32_t l = 0; l < raw_.kernel().layer_count; ++l) {
    const KernelLayer& layer = raw_.kernel().layers[l];
    const bool last = l + 1 == raw_.kernel().layer_count;
    const std::uint64_t weights = last ? std::uint64_t{layer.outputs} * layer.padded_inputs
                                       : std::uint64_t{layer.inputs} * layer.padded_outputs;
    step(std::max(begin, layer.gradient), std::min(end, layer.gradient + weights), options_.adam.l2_network);
    if (layout_.has_biases())
      step(std::max(begin, layer.bias_gradient), std::min(end, layer.bias_gradient + layer.outputs), 0.0f);
  }
  raw_.update(begin, end);
  return skipped;
}

void NetworkStore::export_to(ModelState& state) const {
  const auto put = [&](std::vector<float>& to, const HugeBuffer<float>& from) {
    to.resize(parameters_.count);
    layout_.unpack(from.data(), std::span(to).subspan(parameters_.network));
  };
  put(state.parameters, arrays_.parameters);
  put(state.averages, options_.average.network ? arrays_.averages : arrays_.parameters);
  put(state.first_moments, arrays_.first_moments);
  put(state.second_moments, arrays_.second_moments);
}

NetworkStore::Arrays NetworkStore::arrays_of(const ModelState& state) const {
  Arrays arrays = new_arrays(layout_.size());
  const auto take = [&](const std::vector<float>& from, const HugeBuffer<float>& to) {
    layout_.pack(std::span(from).subspan(parameters_.network), to.data());
  };
  take(state.parameters, arrays.parameters);
  take(state.averages, arrays.averages);
  take(state.first_moments, arrays.first_moments);
  take(state.second_moments, arrays.second_moments);
  return arrays;
}

void NetworkStore::set(const Arrays& arrays) {
  const auto put = [&](const HugeBuffer<float>& from, const HugeBuffer<float>& to) {
    std::copy_n(from.data(), layout_.size(), to.data());
  };
  put(arrays.parameters, arrays_.parameters);
  put(arrays.averages, arrays_.averages);
  put(arrays.first_moments, arrays_.first_moments);
  put(arrays.second_moments, arrays_.second_moments);
  raw_.update();
  updated();
}

}  // namespace gatelight::neural::cpu
