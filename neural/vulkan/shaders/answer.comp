#version 460
// Answers queries: encodes a tile of points into shared memory and applies the network there. A workgroup
// copies the weights to shared memory once, if they fit, and then answers several tiles. In a hidden layer, a
// thread computes kColumns outputs of four points: 4 + kColumns values that it reads serve 4 * kColumns
// products, and neighbouring threads read the same weights and neighbouring points.

#include "blocks.glsl"
#include "gate.glsl"
#include "halves.glsl"
#include "hash_grid.glsl"
#include "inputs.glsl"
#include "network.glsl"

layout(constant_id = 6) const uint kTile = 4;
layout(constant_id = 7) const float kSlope = 0.01;
layout(constant_id = 8) const bool kRounded = false;
layout(constant_id = 9) const uint kStaged = 1;  // vectors of weights in shared memory; 1: none
layout(constant_id = 10) const uint kEncoding = 0;
layout(constant_id = 11) const bool kHalves = false;
layout(constant_id = 12) const uint kFeatures = 1;
const bool kTraining = false;

const uint kRows = kInputs > kWidth ? kInputs : kWidth;
const uint kFours = kTile / 4u;
const uint kColumns = kWidth < 32u ? 4u : 8u;

shared vec4 rows[kRows * kFours];  // [input or neuron][four points]
shared vec4 staged[kStaged];
shared uint statuses[kTile];

uint record, place;  // of the point, in the query and in the tile

void put(uint row, float value) {
  rows[row * kFours + place / 4u][place % 4u] = kRounded ? to_bf16(value) : value;
}

void put_reference(uint slot, uint node, float weight) {}

#include "encode.glsl"

// Inputs of rejected points keep older values, as nothing reads their answers.
void encode_tile(uint first) {
  for (place = gl_LocalInvocationIndex; place < kTile; place += kThreads) {
    record = first + place;
    statuses[place] = record < batch.size ? status_of_record() : kStatusRejected;
  }
  barrier();
  for (uint item = gl_LocalInvocationIndex; item < kTile * parts_to_encode(); item += kThreads) {
    place = item % kTile;
    record = first + place;
    if (statuses[place] != kStatusRejected) encode_part(item / kTile, statuses[place]);
  }
  barrier();
}

void stage_weights() {
  if (kStaged == 1u) return;
  for (uint i = gl_LocalInvocationIndex; i < kStaged; i += kThreads) staged[i] = batch.forward.at[i];
  barrier();
}

vec4 weights_at(uint at) {
  return kStaged == 1u ? batch.forward.at[at] : staged[at];
}

// Replaces the layer's inputs by its outputs. The tile has at most one block of outputs for each thread.
void hidden_layer(uint layer) {
  const uint four = gl_LocalInvocationIndex % kFours, column = gl_LocalInvocationIndex / kFours * kColumns;
  const bool busy = column < kWidth;
  vec4 sums[kColumns];
  if (busy) {
    const uint inputs = layer_inputs(layer);
    uint at = (forward_weights(layer) + column) / 4u;
    [[unroll]] for (uint c = 0u; c < kColumns; c += 4u) {
      const vec4 bias = weights_at(at + inputs * (kWidth / 4u) + c / 4u);
      [[unroll]] for (uint k = 0u; k < 4u; ++k) sums[c + k] = vec4(bias[k]);
    }
    for (uint i = 0u; i < inputs; ++i, at += kWidth / 4u) {
      const vec4 x = rows[i * kFours + four];
      [[unroll]] for (uint c = 0u; c < kColumns; c += 4u) {
        const vec4 w = weights_at(at + c / 4u);
        [[unroll]] for (uint k = 0u; k < 4u; ++k) sums[c + k] += x * w[k];
      }
    }
  }
  barrier();
  if (busy) {
    [[unroll]] for (uint c = 0u; c < kColumns; ++c) {
      const vec4 y = max(sums[c], kSlope * sums[c]);
      rows[(column + c) * kFours + four] = kRounded ? vec4(to_bf16(y.x), to_bf16(y.y), to_bf16(y.z), to_bf16(y.w)) : y;
    }
  }
  barrier();
}

// Values of Push::argument.
const uint kRaw = 0;
const uint kUnit = 2;

float in_range(float y) {
  if (argument == kRaw) return y;
  if (!finite(y)) return 0.0;
  return argument == kUnit ? clamp(y, 0.0, 1.0) : max(y, 0.0);
}

// The layer of outputs: four outputs of a point per thread.
void answer_tile(uint first) {
  const uint across = to_eights(kOutputs) / 4u;
  for (uint item = gl_LocalInvocationIndex; item < kTile * ((kOutputs + 3u) / 4u); item += kThreads) {
    const uint p = item % kTile, o = item / kTile * 4u;
    if (first + p >= batch.size) continue;
    uint at = (forward_weights(kHidden) + o) / 4u;
    vec4 y = weights_at(at + kWidth * across);
    for (uint i = 0u; i < kWidth; ++i, at += across) y += rows[i * kFours + p / 4u][p % 4u] * weights_at(at);
    if (statuses[p] == kStatusRejected) y = vec4(uintBitsToFloat(0x7fc00000u));
    for (uint k = 0u; k < 4u && o + k < kOutputs; ++k)
      batch.answers.at[(first + p) * kOutputs + o + k] = in_range(y[k]);
  }
  barrier();
}

void main() {
  stage_weights();
  for (uint tile = flat_group(); tile < batch.tiles; tile += batch.groups) {
    encode_tile(tile * kTile);
    for (uint layer = 0u; layer < kHidden; ++layer) hidden_layer(layer);
    answer_tile(tile * kTile);
  }
}
