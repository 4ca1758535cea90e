// Writes a network parameter to its places in the packed weights that products read. Includes network.glsl.

#include "network.glsl"

void pack_forward(uint p, float value) {
  const uint layer = layer_of(p), inputs = layer_inputs(layer);
  uint at = forward_weights(layer);
  if (p >= flat_biases(layer))
    at += inputs * forward_row(layer) + (p - flat_biases(layer));
  else
    at += (p - flat_weights(layer)) % inputs * forward_row(layer) + (p - flat_weights(layer)) / inputs;
  Floats(batch.forward).at[at] = value;
}

void pack_backward(uint p, float value) {
  const uint layer = layer_of(p), inputs = layer_inputs(layer);
  if (p >= flat_biases(layer)) return;
  const uint o = (p - flat_weights(layer)) / inputs, i = (p - flat_weights(layer)) % inputs;
  if (layer > 0u || i < kFeatureInputs)
    model.backward.at[backward_weights(layer) + o * backward_row(layer) + i] = value;
}
