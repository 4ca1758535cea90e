#version 460
// Packs the network's parameters for products, one parameter per thread. Padding stays zero. Push::argument
// has the bits kPackBackward (backward weights too), kPackAveraged (of the averages) and kPackRounded (to bf16).

#define GATELIGHT_SHAPE_OF_MODEL
#include "blocks.glsl"
#include "pack.glsl"

bool wants(uint what) {
  return (argument & what) != 0u;
}

void main() {
  const uint p = flat_thread();
  if (p >= model.network_count) return;
  const float value = wants(kPackAveraged) ? model.network_average.at[p] : model.parameters.at[p];
  const bool is_weight = p < flat_biases(layer_of(p));
  pack_forward(p, is_weight && wants(kPackRounded) ? to_bf16(value) : value);
  if (wants(kPackBackward)) pack_backward(p, value);
}
