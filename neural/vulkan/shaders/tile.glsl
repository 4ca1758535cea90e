// A tile of records in shared memory, [row][record]: rows are inputs and neurons. The odd stride keeps rows and
// columns free of bank conflicts. Includers declare `rows` and kTile.

const uint kStride = kTile + 1u;

uint row_place(uint row, uint r) {
  return row * kStride + r;
}

// Rounded to bf16, to nearest even; what is not finite stays so.
float to_bf16(float x) {
  const uint bits = floatBitsToUint(x);
  return finite(x) ? uintBitsToFloat(bits + 0x7fffu + (bits >> 16 & 1u) & 0xffff0000u) : x;
}

void load_inputs(uint first, uint row, bool rounded) {
  for (uint item = gl_LocalInvocationIndex; item < kTile * kInputs; item += kThreads) {
    const uint r = item % kTile, i = item / kTile, record = first + r;
    const float x = record < batch.size ? batch.inputs.at[i * batch.capacity + record] : 0.0;
    rows[row_place(row + i, r)] = rounded ? to_bf16(x) : x;
  }
}

// Rows y = W x + b and the activation: a thread computes eight outputs of a record, so that a row's number is
// read once for eight products and weights are the same for neighbouring threads.
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
