#version 460
// Packs the network's parameters for products, one parameter per thread. Padding stays zero. Bits of
// Push::argument: 0 packs backward weights too, 1 packs the averages, 2 rounds to bf16.
#extension GL_GOOGLE_include_directive : require

#define GATELIGHT_SHAPE_OF_MODEL
#include "blocks.glsl"
#include "network.glsl"

layout(local_size_x = kThreads) in;

const uint kBackward = 1;
const uint kAveraged = 2;
const uint kRounded = 4;

bool wants(uint what) {
  return (argument & what) != 0u;
}

void put(uint at, float value) {
  Floats(batch.forward).at[at] = value;
}

float rounded(float x) {
  const uint bits = floatBitsToUint(x);
  return finite(x) ? uintBitsToFloat(bits + 0x7fffu + (bits >> 16 & 1u) & 0xffff0000u) : x;
}

void main() {
  const uint p = flat_thread();
  if (p >= model.network_count) return;
  uint layer = kHidden;
  while (layer > 0u && flat_weights(layer) > p) --layer;
  const uint inputs = layer_inputs(layer);
  const float value = wants(kAveraged) ? model.network_average.at[p] : model.parameters.at[p];
  if (p >= flat_biases(layer)) {
    put(forward_weights(layer) + inputs * forward_row(layer) + (p - flat_biases(layer)), value);
    return;
  }
  const uint o = (p - flat_weights(layer)) / inputs, i = (p - flat_weights(layer)) % inputs;
  put(forward_weights(layer) + i * forward_row(layer) + o, wants(kRounded) ? rounded(value) : value);
  if (wants(kBackward) && (layer > 0u || i < kFeatureInputs))
    model.backward.at[backward_weights(layer) + o * backward_row(layer) + i] = value;
}
