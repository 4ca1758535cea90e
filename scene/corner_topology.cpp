#include "scene/corner_topology.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gatelight::scene {
namespace {

void mix(std::uint64_t& hash, float x) {
  hash ^= std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 equals 0
  hash *= 0x9e3779b97f4a7c15u;
  hash ^= hash >> 32;
}

/// The ends of a corner's edge, the smaller vertex first.
struct Edge {
  std::uint32_t low, high;
  bool ascends;  ///< from the smaller to the larger vertex
};

Edge edge_of(std::span<const Triangle> triangles, std::span<const std::uint32_t> welded,
             std::uint32_t corner) {
  const Triangle& t = triangles[corner / 3];
  const std::uint32_t a = welded[t[corner % 3]];
  const std::uint32_t b = welded[t[next_corner(corner) % 3]];
  return {std::min(a, b), std::max(a, b), a < b};
}

/// Pairs corners that run through one edge in opposite directions; the waiting ones all have one direction.
class Pairing {
 public:
  explicit Pairing(std::vector<std::uint32_t>& neighbors) : neighbors_(neighbors) {}

  void begin() {
    waiting_.clear();
    first_ = 0;
  }
  void add(std::uint32_t corner, bool ascends) {
    if (first_ < waiting_.size() && ascends != ascends_) {
      const std::uint32_t other = waiting_[first_++];
      neighbors_[other] = corner;
      neighbors_[corner] = other;
      return;
    }
    ascends_ = ascends;
    waiting_.push_back(corner);
  }

 private:
  std::vector<std::uint32_t>& neighbors_;
  std::vector<std::uint32_t> waiting_;
  std::size_t first_ = 0;
  bool ascends_ = false;
};

}  // namespace

std::vector<std::uint32_t> weld_vertices(std::span<const Vec3> positions, std::span<const Vec3> normals,
                                         std::span<const Vec2> uv) {
  const auto hash_of = [&](std::size_t i) {
    std::uint64_t hash = 0;
    for (const float x : positions[i]) mix(hash, x);
    for (const float x : normals[i]) mix(hash, x);
    if (!uv.empty()) {
      for (const float x : uv[i]) mix(hash, x);
    }
    return hash;
  };
  const auto equal = [&](std::size_t i, std::size_t j) {
    return positions[i] == positions[j] && normals[i] == normals[j] && (uv.empty() || uv[i] == uv[j]);
  };
  // A hash table with open addresses, which is at most half full.
  std::vector<std::uint32_t> table(std::bit_ceil(2 * positions.size() + 1), kNoCorner);
  std::vector<std::uint32_t> welded(positions.size());
  for (std::uint32_t i = 0; i < welded.size(); ++i) {
    std::size_t slot = hash_of(i) & (table.size() - 1);
    while (table[slot] != kNoCorner && !equal(table[slot], i)) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == kNoCorner) table[slot] = i;
    welded[i] = table[slot];
  }
  return welded;
}

std::vector<std::uint32_t> connect_edges(std::span<const Triangle> triangles, std::span<const Vec3> positions,
                                         std::span<const std::uint32_t> welded) {
  // The corners in buckets by the smaller vertex of their edge. `ends` first holds the begin of each bucket.
  std::vector<std::uint32_t> ends(welded.size() + 1, 0);
  const auto corner_count = static_cast<std::uint32_t>(3 * triangles.size());
  for (std::uint32_t c = 0; c < corner_count; ++c) {
    if (!is_degenerate(triangles[c / 3], positions)) ++ends[edge_of(triangles, welded, c).low + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  struct Entry {
    std::uint32_t high, corner;
  };
  std::vector<Entry> entries(ends.back());
  for (std::uint32_t c = 0; c < corner_count; ++c) {
    if (is_degenerate(triangles[c / 3], positions)) continue;
    const Edge edge = edge_of(triangles, welded, c);
    entries[ends[edge.low]++] = {edge.high, c};
  }

  std::vector<std::uint32_t> neighbors(corner_count, kNoCorner);
  Pairing pairing(neighbors);
  std::uint32_t begin = 0;
  for (std::size_t low = 0; low < welded.size(); ++low) {
    const std::span<Entry> bucket(entries.data() + begin, ends[low] - begin);
    begin = ends[low];
    std::sort(bucket.begin(), bucket.end(), [](const Entry& a, const Entry& b) {
      return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      if (i == 0 || bucket[i].high != bucket[i - 1].high) pairing.begin();
      pairing.add(bucket[i].corner, edge_of(triangles, welded, bucket[i].corner).ascends);
    }
  }
  return neighbors;
}

}  // namespace gatelight::scene
