#version 460
// Packs the network's parameters for products, one parameter per thread. Padding stays zero. Push::argument
// has the bits kPackBackward (backward weights too), kPackAveraged (of the averages) and kPackRounded (to bf16).

#define GATELIGHT_SHAPE_OF_MODEL
#include "blocks.glsl"
#include "network.glsl"

bool wants(uint what) {
  return (argument & what) != 0u;
}

void put(uint at, float value) {
  Floats(batch.forward).at[at] = value;
}

void main() {
  const uint p = flat_thread();
  if (p >= model.network_count) return;
  const uint layer = layer_of(p);
  const uint inputs = layer_inputs(layer);
  const float value = wants(kPackAveraged) ? model.network_average.at[p] : model.parameters.at[p];
  if (p >= flat_biases(layer)) {
    put(forward_weights(layer) + inputs * forward_row(layer) + (p - flat_biases(layer)), value);
    return;
  }
  const uint o = (p - flat_weights(layer)) / inputs, i = (p - flat_weights(layer)) % inputs;
  put(forward_weights(layer) + i * forward_row(layer) + o, wants(kPackRounded) ? to_bf16(value) : value);
  if (wants(kPackBackward) && (layer > 0u || i < kFeatureInputs))
    model.backward.at[backward_weights(layer) + o * backward_row(layer) + i] = value;
}
