// The kernels for training, queries and node updates. This file is compiled once for each instruction set
// (see simd/vectors.h). Encode, forward, loss and backward are fused per tile, so that activations stay in
// the caches.

#include "neural/cpu/kernels.h"

#include "neural/cpu/kernel_bf16.h"
#include "neural/cpu/kernel_inputs.h"
#include "neural/cpu/kernel_interpolate.h"
#include "neural/cpu/kernel_loss.h"
#include "neural/cpu/kernel_network.h"
#include "neural/cpu/kernel_points.h"
#include "neural/cpu/kernel_update.h"

namespace {

static_assert(kTile % kLanes == 0 && kTile % kBlockRows == 0);

// The buffers begin with the rows of inputs.
GATELIGHT_INLINE TileBuffers tile_buffers(const KernelNetwork& n, float* scratch) {
  TileBuffers b;
  const uint64_t hidden = uint64_t{kTile} * n.width;
  b.inputs = scratch;
  scratch += uint64_t{kTile} * n.input_stride;
  for (uint32_t l = 0; l + 1 < n.layer_count; ++l, scratch += hidden) b.hidden[l] = scratch;
  b.outputs = scratch;
  scratch += kTile * kOutputStride;
  b.spare = scratch;
  return b;
}

GATELIGHT_INLINE uint64_t buffer_floats(const KernelNetwork& n) {
  return kTile * (2 * uint64_t{n.input_stride} + uint64_t{n.width} * (n.layer_count - 1) + kOutputStride);
}

GATELIGHT_INLINE uint32_t padded_rows(uint32_t count) {
  return (count + kBlockRows - 1) / kBlockRows * kBlockRows;
}

GATELIGHT_INLINE uint32_t tile_count(uint64_t begin, uint64_t end, uint64_t tile) {
  const uint64_t first = begin + tile * kTile;
  return static_cast<uint32_t>(end - first < kTile ? end - first : kTile);
}

// Number of between_blocks calls in a tile's forward pass, for the pace of prefetching.
GATELIGHT_INLINE uint32_t forward_blocks(const KernelNetwork& n) {
  const uint32_t wide = (n.width + kBlockVectors * kLanes - 1) / (kBlockVectors * kLanes);
  return kTile / kBlockRows * (wide * (n.layer_count - 1) + 1);
}

void train(const KernelTraining& t) {
  const KernelEncoder& e = *t.encoder;
  const KernelNetwork& n = *t.network;
  const TileBuffers b = tile_buffers(n, t.scratch);
  float* const inputs = t.scratch;
  const uint32_t slots = e.levels * e.nodes_per_level;
  const uint64_t tiles = (uint64_t{t.end} - t.begin + kTile - 1) / kTile;
  const uint64_t first_tile = t.begin / kTile;
  TilePoints points[2];
  __builtin_memset(inputs, 0, kTile * n.input_stride * sizeof(float));
  __builtin_memset(b.outputs, 0, kTile * kOutputStride * sizeof(float));

  const auto prepare = [&](uint64_t k) {
    const uint64_t begin = t.begin + k * kTile;
    const uint32_t count = tile_count(t.begin, t.end, k);
    TilePoints& tile = points[k & 1];
    uint32_t* nodes = t.nodes + (first_tile + k) * slots * kTile;
    float* weights = t.weights + (first_tile + k) * slots * kTile;
    KernelChunkStatistics& statistics = t.statistics[k / t.chunk_tiles];
    if (k % t.chunk_tiles == 0) statistics = {};
    statistics.rejected += take_points(e, t.points, t.targets, n.outputs, begin, count, tile);
    statistics.unstored += lookup(e, tile, nodes, weights);
    Float accepted = 0.0f;
    for (uint32_t s = 0; s < kTile; s += kLanes) accepted += load(tile.valid + s);
    statistics.accepted += static_cast<uint32_t>(sum(accepted));
    if (uint8_t* flags = t.accepted; flags != nullptr)
      for (uint32_t s = 0; s < count; ++s) flags[begin + s] = tile.valid[s] != 0.0f ? 1 : 0;
  };

  if (tiles > 0) {
    prefetch_points(e, t.points, t.begin, t.begin + tile_count(t.begin, t.end, 0));
    prepare(0);
  }
  for (uint64_t k = 0; k < tiles; ++k) {
    const uint64_t begin = t.begin + k * kTile;
    const uint32_t count = tile_count(t.begin, t.end, k);
    const uint32_t rows = padded_rows(count);
    const TilePoints& tile = points[k & 1];
    KernelChunkStatistics& statistics = t.statistics[k / t.chunk_tiles];
    float* const gradients = t.gradients + k / t.chunk_tiles * t.gradient_size;
    if (k % t.chunk_tiles == 0) __builtin_memset(gradients, 0, t.gradient_size * sizeof(float));
    const uint32_t* nodes = t.nodes + (first_tile + k) * slots * kTile;
    const float* weights = t.weights + (first_tile + k) * slots * kTile;
    if (k + 2 < tiles)
      prefetch_points(e, t.points, begin + 2 * kTile, begin + 2 * kTile + tile_count(t.begin, t.end, k + 2));
    Prefetcher ahead;
    if (k + 1 < tiles) {
      prepare(k + 1);
      ahead = make_prefetcher(e, nodes + slots * kTile, 3 * forward_blocks(n));
    }
    const Between between{&ahead};

    if (slots > 0) interpolate(e, nodes, weights, inputs, n.input_stride);
    encode_auxiliary(e, t.points, begin, count, k + 1 == tiles, tile.valid, inputs, n.input_stride);
    forward<false>(n, b, rows, between);
    statistics.loss += loss(n.outputs, t.relative_loss != 0, t.max_target, t.targets + begin * n.outputs,
                            tile.valid, count, rows, b.outputs, statistics.clipped);
    float* feature_gradients = t.feature_gradients + begin * n.feature_inputs;
    backward(
        n, b, rows, gradients,
        [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
          if (r >= count || c >= n.feature_inputs) return;
          float* to = feature_gradients + r * n.feature_inputs + c;
          if (c + kLanes <= n.feature_inputs)
            store(to, a);
          else
            store_partial(to, a, n.feature_inputs - c);
        },
        between);
    ahead.rest();
  }
}

// Replaces values that are not finite by 0, then clamps to the range.
GATELIGHT_INLINE Short4 in_range(Short4 y, uint32_t range) {
  typedef int32_t Int4 __attribute__((vector_size(16)));
  if (range == 0) return y;
  const Short4 greatest = Short4{} + __FLT_MAX__;
  y = (Short4)((Int4)y & (y > Short4{}) & (y <= greatest));
  if (range == 2) y = (Short4)(((Int4)y & (y < 1.0f)) | ((Int4)(Short4{} + 1.0f) & (y >= 1.0f)));
  return y;
}

GATELIGHT_INLINE void write_outputs(const float* y, uint32_t outputs, uint32_t count, uint32_t range,
                                    float* out) {
  for (uint32_t c = 0; c < outputs; c += 4) {
    const uint32_t used = outputs - c < 4 ? outputs - c : 4;
    for (uint32_t s = 0; s < count; ++s) {
      const Short4 answers = in_range(load_short<Short4>(y + s * kOutputStride + c), range);
      float* to = out + s * outputs + c;
      // Store four values even if fewer are used, if the next row overwrites the rest.
      if (used == 4 || (outputs < 4 && s * outputs + 4 <= count * outputs)) {
        store_short(to, answers);
      } else {
        for (uint32_t i = 0; i < used; ++i) to[i] = answers[i];
      }
    }
  }
}

// Writes NaN for points with an input that is not finite; they were encoded as zeros.
GATELIGHT_INLINE void answer_nan(const TilePoints& points, uint32_t count, uint32_t outputs, float* y) {
  for (uint32_t s = 0; s < count; ++s)
    for (uint32_t c = 0; c < outputs && points.finite[s] == 0.0f; ++c)
      y[s * kOutputStride + c] = __builtin_nanf("");
}

void query(const KernelQuery& q) {
  const KernelEncoder& e = *q.encoder;
  const KernelNetwork& n = *q.network;
  const TileBuffers b = tile_buffers(n, q.scratch);
  float* const inputs = q.scratch;
  const uint32_t slots = e.levels * e.nodes_per_level;
  float* ring = q.scratch + buffer_floats(n);  // nodes and weights of two tiles
  const uint64_t tiles = (q.end - q.begin + kTile - 1) / kTile;
  TilePoints points[2];
  uint32_t rejected[2] = {};
  __builtin_memset(inputs, 0, kTile * n.input_stride * sizeof(float));

  const auto nodes_of = [&](uint64_t k) {
    return reinterpret_cast<uint32_t*>(ring) + (k & 1) * slots * kTile;
  };
  const auto weights_of = [&](uint64_t k) { return ring + (2 + (k & 1)) * slots * kTile; };
  const auto prepare = [&](uint64_t k) {
    TilePoints& tile = points[k & 1];
    rejected[k & 1] =
        take_points(e, q.points, nullptr, 0, q.begin + k * kTile, tile_count(q.begin, q.end, k), tile);
    lookup(e, tile, nodes_of(k), weights_of(k));
  };

  if (tiles > 0) {
    prefetch_points(e, q.points, q.begin, q.begin + tile_count(q.begin, q.end, 0));
    prepare(0);
  }
  for (uint64_t k = 0; k < tiles; ++k) {
    const uint64_t begin = q.begin + k * kTile;
    const uint32_t count = tile_count(q.begin, q.end, k);
    const uint32_t rows = padded_rows(count);
    if (k + 2 < tiles)
      prefetch_points(e, q.points, begin + 2 * kTile, begin + 2 * kTile + tile_count(q.begin, q.end, k + 2));
    Prefetcher ahead;
    if (k + 1 < tiles) {
      prepare(k + 1);
      ahead = make_prefetcher(e, nodes_of(k + 1), forward_blocks(n));
    }
    const Between between{&ahead};

    if (slots > 0) interpolate(e, nodes_of(k), weights_of(k), inputs, n.input_stride);
    encode_auxiliary(e, q.points, begin, count, k + 1 == tiles, points[k & 1].finite, inputs, n.input_stride);
    if (q.bf16 != 0)
      forward_bf16(n, b, inputs, rows, between);
    else
      forward<false>(n, b, rows, between);
    ahead.rest();
    if (rejected[k & 1] != 0) answer_nan(points[k & 1], count, n.outputs, b.outputs);
    write_outputs(b.outputs, n.outputs, count, q.range, q.out + begin * n.outputs);
  }
}

uint64_t scratch_floats(const KernelEncoder& e, const KernelNetwork& n) {
  return buffer_floats(n) + 4 * uint64_t{e.levels} * e.nodes_per_level * kTile;
}

}  // namespace

namespace gatelight::neural::cpu {

extern const KernelTable GATELIGHT_KERNEL_TABLE;
const KernelTable GATELIGHT_KERNEL_TABLE = {scratch_floats, train, query, update_features};

}  // namespace gatelight::neural::cpu
