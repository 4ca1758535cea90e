#version 460
// Answers queries: a forward pass over tiles of points. Layers alternate between two sets of rows.

#include "blocks.glsl"
#include "network.glsl"

layout(constant_id = 6) const uint kTile = 1;
layout(constant_id = 7) const float kSlope = 0.01;
layout(constant_id = 8) const bool kRounded = false;

const uint kSecondRows = kInputs > kWidth ? kInputs : kWidth;

shared float rows[(kSecondRows + kWidth) * (kTile + 1u)];

#include "tile.glsl"

// Values of Push::argument.
const uint kRaw = 0;
const uint kUnit = 2;

float in_range(float y) {
  if (argument == kRaw) return y;
  if (!finite(y)) return 0.0;
  return argument == kUnit ? clamp(y, 0.0, 1.0) : max(y, 0.0);
}

void write_answers(uint first, uint row) {
  for (uint item = gl_LocalInvocationIndex; item < kTile * kOutputs; item += kThreads) {
    const uint r = item / kOutputs, o = item % kOutputs, record = first + r;
    if (record >= batch.size) continue;
    float y = rows[row_place(row + o, r)];
    if (batch.status.at[record] == kStatusRejected) y = uintBitsToFloat(0x7fc00000u);
    batch.answers.at[record * kOutputs + o] = in_range(y);
  }
}

void main() {
  const uint tile = flat_group();
  if (tile >= batch.tiles) return;
  const uint first = tile * kTile;
  uint x = 0u, y = kSecondRows;
  load_inputs(first, x, kRounded);
  barrier();
  for (uint layer = 0u; layer <= kHidden; ++layer) {
    forward_layer(batch.forward, layer, x, y, kSlope, kRounded);
    barrier();
    const uint swapped = x;
    x = y;
    y = swapped;
  }
  write_answers(first, x);
}
