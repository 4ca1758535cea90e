// The network's shape and the offsets of its parameters: flat as in ParameterLayout (from the first weight
// on), and packed for products. Layers 0 .. kHidden - 1 are hidden; layer kHidden computes the outputs.

// The shape is in specialization constants or, if GATELIGHT_SHAPE_OF_MODEL is defined, in the model's words.
// Shaders without arrays of these sizes use the latter, so that one pipeline serves all models.
#ifdef GATELIGHT_SHAPE_OF_MODEL
#define kInputs model.inputs
#define kFeatureInputs model.feature_inputs
#define kWidth model.width
#define kHidden model.hidden_layers
#define kOutputs model.outputs
#define kBiases (model.biases != 0u)
#else
layout(constant_id = 0) const uint kInputs = 1;
layout(constant_id = 1) const uint kFeatureInputs = 0;
layout(constant_id = 2) const uint kWidth = 16;
layout(constant_id = 3) const uint kHidden = 1;
layout(constant_id = 4) const uint kOutputs = 1;
layout(constant_id = 5) const bool kBiases = true;
#endif

uint to_eights(uint n) {
  return (n + 7u) / 8u * 8u;
}

uint layer_inputs(uint layer) {
  return layer == 0u ? kInputs : kWidth;
}

uint layer_outputs(uint layer) {
  return layer == kHidden ? kOutputs : kWidth;
}

// Flat: W [output][input], then biases.
uint flat_weights(uint layer) {
  const uint biases = kBiases ? 1u : 0u;
  return layer == 0u ? 0u : kWidth * (kInputs + biases) + (layer - 1u) * kWidth * (kWidth + biases);
}

uint flat_biases(uint layer) {
  return flat_weights(layer) + layer_inputs(layer) * layer_outputs(layer);
}

// The layer of a parameter.
uint layer_of(uint p) {
  uint layer = kHidden;
  while (layer > 0u && flat_weights(layer) > p) --layer;
  return layer;
}

// Packed forward, in floats: [input][outputs to eights], then a row of biases.
uint forward_weights(uint layer) {
  return layer == 0u ? 0u : kWidth * (kInputs + 1u) + (layer - 1u) * kWidth * (kWidth + 1u);
}

uint forward_row(uint layer) {
  return to_eights(layer_outputs(layer));
}

// Packed backward, in floats: [output][inputs to eights]; layer 0 has the feature inputs only.
uint backward_weights(uint layer) {
  return layer == 0u ? 0u : kWidth * to_eights(kFeatureInputs) + (layer - 1u) * kWidth * kWidth;
}

uint backward_row(uint layer) {
  return layer == 0u ? to_eights(kFeatureInputs) : kWidth;
}

// Rounds to bf16, to nearest even; values that are not finite stay so.
float to_bf16(float x) {
  const uint bits = floatBitsToUint(x);
  return finite(x) ? uintBitsToFloat(bits + 0x7fffu + (bits >> 16 & 1u) & 0xffff0000u) : x;
}
