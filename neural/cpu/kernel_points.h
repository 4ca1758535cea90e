#pragma once
// Reads a tile's points from the batch: checks which are finite, and copies them if lookups cannot read whole
// vectors in place. Part of kernel_table.cpp.

#include "neural/cpu/kernel_lookup.h"

namespace {

// Whether all of `count` floats are finite.
GATELIGHT_INLINE bool all_finite(const float* p, uint32_t count) {
  Float total = 0.0f;
  uint32_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    const Float x = load(p + i);
    total += x - x;
  }
  if (i < count) {
    const Float x = load_partial(p + i, count - i);
    total += x - x;
  }
  return all(total == 0.0f);
}

struct FiniteSpan {
  const float* p;
  uint32_t width;
};

// Copies `count` rows of `width` words. Rows up to kTile and rows with `finite` 0 become zeros.
template <class Word>
GATELIGHT_INLINE void copy_rows(Word* to, const Word* from, uint32_t width, uint32_t count,
                                const float* finite) {
  for (uint32_t s = 0; s < kTile; ++s)
    for (uint32_t c = 0; c < width; ++c)
      to[s * width + c] = s < count && finite[s] != 0.0f ? from[s * width + c] : 0;
}

// Sets up points [begin, begin + count). `valid` and `finite` become 1 if all inputs, and the target if there
// is one, are finite. Returns the number of points that are not.
GATELIGHT_NOINLINE uint32_t take_points(const KernelEncoder& e, const KernelPoints& points,
                                        const float* targets, uint32_t outputs, uint64_t begin,
                                        uint32_t count, TilePoints& tile) {
  const FiniteSpan spans[7] = {{points.barycentrics, 2}, {points.positions, 3}, {points.directions, 3},
                               {points.normals, 3},      {points.albedos, 3},   {points.roughnesses, 1},
                               {targets, outputs}};
  for (uint32_t s = 0; s < kTile; ++s) tile.finite[s] = s < count ? 1.0f : 0.0f;
  uint32_t rejected = 0;
  for (const FiniteSpan& span : spans) {
    if (span.p == nullptr) continue;
    const float* p = span.p + begin * span.width;
    if (all_finite(p, count * span.width)) continue;
    for (uint32_t s = 0; s < count; ++s)
      if (tile.finite[s] != 0.0f && !all_finite(p + s * span.width, span.width)) {
        tile.finite[s] = 0.0f;
        ++rejected;
      }
  }
  for (uint32_t s = 0; s < kTile; s += kLanes) store(tile.valid + s, load(tile.finite + s));

  const bool copies = count < kTile || rejected != 0;
  if (e.encoding == KernelEncoding::gate) {
    tile.surfaces = points.surfaces + begin;
    tile.triangles = points.triangles + begin;
    tile.barycentrics = points.barycentrics + 2 * begin;
    if (copies) {
      copy_rows(tile.surface_copies, tile.surfaces, 1, count, tile.finite);
      copy_rows(tile.triangle_copies, tile.triangles, 1, count, tile.finite);
      copy_rows(tile.barycentric_copies, tile.barycentrics, 2, count, tile.finite);
      tile.surfaces = tile.surface_copies;
      tile.triangles = tile.triangle_copies;
      tile.barycentrics = tile.barycentric_copies;
    }
  } else if (e.encoding == KernelEncoding::hash_grid) {
    tile.positions = points.positions + 3 * begin;
    if (copies) {
      copy_rows(tile.position_copies, tile.positions, 3, count, tile.finite);
      tile.positions = tile.position_copies;
    }
  }
  return rejected;
}

// Finds the nodes and weights of a tile. Returns the number of finite points without storage.
GATELIGHT_INLINE uint32_t lookup(const KernelEncoder& e, TilePoints& tile, uint32_t* nodes, float* weights) {
  if (e.encoding == KernelEncoding::gate) return lookup_gate(e, tile, nodes, weights);
  if (e.encoding == KernelEncoding::hash_grid) lookup_hash_grid(e, tile, nodes, weights);
  return 0;
}

}  // namespace
