#version 460
// Forward, loss and backward over tiles of records in shared memory. In the backward pass gradients overwrite
// their values. A workgroup adds the weight gradients of its tiles to its own sums.

#include "blocks.glsl"
#include "network.glsl"

layout(constant_id = 6) const uint kTile = 1;
layout(constant_id = 7) const float kSlope = 0.01;
layout(constant_id = 8) const bool kRelativeLoss = true;

const uint kFirstHidden = kInputs;
const uint kOutputRow = kInputs + kHidden * kWidth;
const uint kRows = kOutputRow + 16u;

shared float rows[kRows * (kTile + 1u)];
shared float record_losses[kTile];

#include "tile.glsl"

uint input_row(uint layer) {
  return layer == 0u ? 0u : kFirstHidden + (layer - 1u) * kWidth;
}

uint output_row(uint layer) {
  return kFirstHidden + layer * kWidth;
}

float luminance(uint r) {
  float sum = 0.0;
  if (kOutputs == 3u)
    return 0.299 * rows[row_place(kOutputRow, r)] + 0.587 * rows[row_place(kOutputRow + 1u, r)] +
           0.114 * rows[row_place(kOutputRow + 2u, r)];
  for (uint o = 0u; o < kOutputs; ++o) sum += rows[row_place(kOutputRow + o, r)];
  return sum / float(kOutputs);
}

// Replaces outputs by derivatives of the sum of (y - t)^2 / denominator. The updates divide by records and
// outputs.
void take_loss(uint first) {
  const uint r = gl_LocalInvocationIndex;
  if (r >= kTile) return;
  const uint record = first + r;
  const bool accepted = record < batch.size && batch.status.at[min(record, batch.size - 1u)] == kStatusAccepted;
  float inverse = 1.0;
  if (kRelativeLoss) {
    const float y = luminance(r);
    inverse = 1.0 / (y * y + 0.01);
  }
  float loss = 0.0;
  bool clipped = false;
  for (uint o = 0u; o < kOutputs; ++o) {
    const uint at = row_place(kOutputRow + o, r);
    float gradient = 0.0;
    if (accepted) {
      float target = batch.targets.at[record * kOutputs + o];
      clipped = clipped || abs(target) > model.max_target;
      target = clamp(target, -model.max_target, model.max_target);
      const float difference = rows[at] - target;
      const float scaled = difference * inverse;
      loss += difference * scaled;
      gradient = 2.0 * scaled;
    }
    rows[at] = gradient;
  }
  record_losses[r] = loss;
  if (clipped) atomicAdd(batch.statistics.at[kClipped], 1u);
}

void sum_losses(uint tile) {
  if (gl_LocalInvocationIndex != kThreads - 1u) return;
  float sum = 0.0;
  for (uint r = 0u; r < kTile; ++r) sum += record_losses[r];
  batch.losses.at[tile] = sum;
}

// Sums d x over the tile's records, sixteen sums per thread. A thread's rows are a quarter of all rows apart,
// so that neighbouring threads read neighbouring rows.
void add_weight_gradients(uint layer, uint sums, bool first_tile) {
  const uint inputs = layer_inputs(layer), outputs = layer_outputs(layer);
  const uint x = input_row(layer), d = output_row(layer);
  const uint across = (inputs + 3u) / 4u, down = (outputs + 3u) / 4u;
  for (uint item = gl_LocalInvocationIndex; item < across * down; item += kThreads) {
    const uint i = item % across, o = item / across;
    vec4 s[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint r = 0u; r < kTile; ++r) {
      const vec4 value = vec4(rows[row_place(x + i, r)], rows[row_place(x + i + across, r)],
                              rows[row_place(x + i + 2u * across, r)], rows[row_place(x + i + 3u * across, r)]);
      s[0] += rows[row_place(d + o, r)] * value;
      s[1] += rows[row_place(d + o + down, r)] * value;
      s[2] += rows[row_place(d + o + 2u * down, r)] * value;
      s[3] += rows[row_place(d + o + 3u * down, r)] * value;
    }
    for (uint j = 0u; j < 4u; ++j)
      for (uint k = 0u; k < 4u; ++k) {
        const uint row = o + j * down, column = i + k * across;
        if (row >= outputs || column >= inputs) continue;
        const uint at = sums + flat_weights(layer) + row * inputs + column;
        batch.partials.at[at] = first_tile ? s[j][k] : batch.partials.at[at] + s[j][k];
      }
  }
  if (!kBiases) return;
  for (uint o = gl_LocalInvocationIndex; o < outputs; o += kThreads) {
    float sum = 0.0;
    for (uint r = 0u; r < kTile; ++r) sum += rows[row_place(d + o, r)];
    const uint at = sums + flat_biases(layer) + o;
    batch.partials.at[at] = first_tile ? sum : batch.partials.at[at] + sum;
  }
}

// Propagates gradients through a layer's weights, eight inputs of a record per thread.
void descend(uint layer, uint first) {
  const uint outputs = layer_outputs(layer), d = output_row(layer);
  const uint inputs = layer == 0u ? kFeatureInputs : kWidth;
  const uint columns = backward_row(layer) / 4u;
  Vectors packed_weights = Vectors(model.backward);
  for (uint item = gl_LocalInvocationIndex; item < kTile * (columns / 2u); item += kThreads) {
    const uint r = item % kTile, block = item / kTile;
    uint at = backward_weights(layer) / 4u + 2u * block;
    vec4 low = vec4(0.0), high = vec4(0.0);
    for (uint o = 0u; o < outputs; ++o, at += columns) {
      const float value = rows[row_place(d + o, r)];
      low += value * packed_weights.at[at];
      high += value * packed_weights.at[at + 1u];
    }
    for (uint k = 0u; k < 8u; ++k) {
      const uint i = 8u * block + k;
      const float gradient = k < 4u ? low[k] : high[k - 4u];
      if (layer > 0u) {
        const uint place = row_place(input_row(layer) + i, r);
        rows[place] = gradient * (rows[place] > 0.0 ? 1.0 : kSlope);
      } else if (i < inputs && first + r < batch.size) {
        batch.feature_gradients.at[(first + r) * kFeatureInputs + i] = gradient;
      }
    }
  }
}

void main() {
  const uint group = flat_group();
  if (group >= batch.groups) return;
  const uint sums = group * model.network_count;
  for (uint tile = group; tile < batch.tiles; tile += batch.groups) {
    const uint first = tile * kTile;
    load_inputs(first, 0u, false);
    barrier();
    for (uint layer = 0u; layer <= kHidden; ++layer) {
      forward_layer(Vectors(model.forward), layer, input_row(layer), output_row(layer), kSlope, false);
      barrier();
    }
    take_loss(first);
    barrier();
    sum_losses(tile);
    for (uint up = 0u; up <= kHidden; ++up) {
      const uint layer = kHidden - up;
      add_weight_gradients(layer, sums, tile == group);
      barrier();
      if (layer > 0u || kFeatureInputs > 0u) descend(layer, first);
      barrier();
    }
  }
}
