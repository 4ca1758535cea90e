#include "neural/model/state.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/half.h"

namespace gatelight::neural {

std::vector<float> initial_network(const Model& model, const TrainingOptions& options) {
  const ParameterLayout& layout = model.parameters;
  std::vector<float> network(layout.network_count());
  for (const LayerLayout& layer : layout.layers) {
    const float range = std::sqrt(6.0f / static_cast<float>(layer.inputs + layer.outputs));
    for (std::uint64_t i = layer.weights; i < layer.biases; ++i)
      network[i - layout.network] = range * (2.0f * uniform_float(options.seed, i) - 1.0f);
  }
  return network;
}

ModelState initial_state(const Model& model, const TrainingOptions& options) {
  const ParameterLayout& layout = model.parameters;
  ModelState state;
  state.parameters.resize(layout.count);
  const bool half = options.precision != FeaturePrecision::fp32;
  tbb::parallel_for(std::uint64_t{0}, (layout.network + 65535) / 65536, [&](std::uint64_t block) {
    const std::uint64_t end = std::min(layout.network, (block + 1) * 65536);
    for (std::uint64_t i = block * 65536; i < end; ++i) {
      const float feature = initial_feature(options, i);
      state.parameters[i] = half ? half_to_float(float_to_half(feature)) : feature;
    }
  });
  std::ranges::copy(initial_network(model, options),
                    state.parameters.begin() + static_cast<std::ptrdiff_t>(layout.network));
  state.averages = state.parameters;
  state.first_moments.assign(layout.count, 0.0f);
  state.second_moments.assign(layout.count, 0.0f);
  if (options.update == FeatureUpdate::sparse) state.node_steps.assign(layout.node_count, 0);
  if (options.counts_triangles()) state.triangle_steps.assign(model.gate.triangle_count, 0);
  return state;
}

}  // namespace gatelight::neural
