// A tile of records in shared memory, [row][record]; rows are inputs and neurons. The odd stride avoids bank
// conflicts for rows and columns. The including shader declares `rows` and kTile.

const uint kStride = kTile + 1u;

uint row_place(uint row, uint r) {
  return row * kStride + r;
}

void load_inputs(uint first, uint row, bool rounded) {
  for (uint item = gl_LocalInvocationIndex; item < kTile * kInputs; item += kThreads) {
    const uint r = item % kTile, i = item / kTile, record = first + r;
    const float x = record < batch.size ? batch.inputs.at[i * batch.capacity + record] : 0.0;
    rows[row_place(row + i, r)] = rounded ? to_bf16(x) : x;
  }
}

// Computes rows y = W x + b and the activation. A thread computes eight outputs of a record, so that it reads
// each input once for eight products and neighbouring threads read the same weights.
void forward_layer(Vectors packed_weights, uint layer, uint x, uint y, float slope, bool rounded) {
  const uint inputs = layer_inputs(layer), outputs = layer_outputs(layer);
  const uint columns = forward_row(layer) / 4u;
  for (uint item = gl_LocalInvocationIndex; item < kTile * (columns / 2u); item += kThreads) {
    const uint r = item % kTile, block = item / kTile;
    uint at = forward_weights(layer) / 4u + 2u * block;
    const uint bias = at + inputs * columns;
    vec4 low = packed_weights.at[bias], high = packed_weights.at[bias + 1u];
    for (uint i = 0u; i < inputs; ++i, at += columns) {
      const float value = rows[row_place(x + i, r)];
      low += value * packed_weights.at[at];
      high += value * packed_weights.at[at + 1u];
    }
    if (layer != kHidden) {
      low = max(low, slope * low);
      high = max(high, slope * high);
    }
    for (uint k = 0u; k < 8u; ++k) {
      const float value = k < 4u ? low[k] : high[k - 4u];
      if (8u * block + k < outputs)
        rows[row_place(y + 8u * block + k, r)] = rounded && layer != kHidden ? to_bf16(value) : value;
    }
  }
}
