#include "neural/layout/clusters.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/parallel/loops.h"
#include "base/random.h"
#include "neural/layout/cluster_table.h"
#include "neural/layout/prefix_sum.h"

namespace gatelight::neural {

namespace {

constexpr std::size_t kClusterGrain = 4096;

/// Shifts cell boundaries away from multiples of the cell size, so that rounding does not split planes at
/// round coordinates.
constexpr double kGridShift = 0.3819660112501051;

/// An axis must exceed the earlier ones by this factor to be dominant, so that rounding does not split
/// normals halfway between two axes.
constexpr double kAxisMargin = 1.0 + 1.0 / 64;

/// Dominant axis and sign, 0 to 5.
std::uint64_t facing(const Double3& normal) {
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (std::abs(normal[c]) > kAxisMargin * std::abs(normal[axis])) axis = c;
  return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
}

std::size_t vertex_count(const ClusterInstance& instance) {
  return instance.among.empty() ? instance.topology->vertices.size() : instance.among.size();
}

std::size_t vertex_number(const ClusterInstance& instance, std::size_t place) {
  return instance.among.empty() ? place : instance.among[place];
}

/// Hashes cells, which are doubles, so that no coordinate overflows. The probability that two of n keys
/// collide, which merges their clusters, is n^2 / 2^65.
class ClusterKeys {
 public:
  ClusterKeys(const ClusterInstance& instance, const ClusterGrid& grid)
      : instance_(instance),
        cell_(grid.cell * instance.cell_scale),
        divisor_(grid.divisor),
        offset_(std::floor(kGridShift * grid.divisor)),
        normals_(grid.normals),
        scale_key_(mix_bits(std::bit_cast<std::uint64_t>(instance.cell_scale))),
        normals_to_world_(cofactors(instance.object_to_world)) {}

  /// The key of vertex `place` among those to cluster.
  std::uint64_t operator()(std::size_t place) const {
    const MeshTopology& topology = *instance_.topology;
    const std::size_t vertex = vertex_number(instance_, place);
    const Double3 position = transform_point(instance_.object_to_world,
                                             to_double(instance_.mesh->positions[topology.vertices[vertex]]));
    std::uint64_t key = scale_key_;
    if (normals_) key = mix_bits(key ^ facing(transform_vector(normals_to_world_, topology.normals[vertex])));
    for (const double coordinate : position) {
      double cell = std::floor(coordinate / cell_ + kGridShift);
      if (divisor_ != 1.0) cell = std::floor((cell + offset_) / divisor_);
      key = mix_bits(key ^ std::bit_cast<std::uint64_t>(cell + 0.0));  // -0 becomes 0
    }
    return key == 0 ? 1 : key;
  }

 private:
  const ClusterInstance& instance_;
  double cell_, divisor_, offset_;
  bool normals_;
  std::uint64_t scale_key_;
  Transform normals_to_world_;
};

/// The index of each instance's first vertex among all vertices.
std::vector<std::uint64_t> vertex_offsets(std::span<const ClusterInstance> instances) {
  std::vector<std::uint64_t> offsets(instances.size() + 1, 0);
  for (std::size_t i = 0; i < instances.size(); ++i) offsets[i + 1] = offsets[i] + vertex_count(instances[i]);
  return offsets;
}

/// Calls on_key(instance, vertex, place in the table); the vertex counts among those to cluster. Returns
/// false, early, for more than `limit` keys.
template <class OnKey>
bool insert_vertices(std::span<const ClusterInstance> instances, const ClusterGrid& grid, std::uint64_t limit,
                     ClusterTable& table, std::atomic<std::uint64_t>& count, const OnKey& on_key) {
  std::atomic<bool> over = false;
  for_each(instances.size(), [&](std::size_t i) {
    const ClusterKeys key(instances[i], grid);
    for_each_range(vertex_count(instances[i]), kClusterGrain, [&](std::size_t begin, std::size_t end) {
      if (over.load(std::memory_order_relaxed)) return;
      std::uint64_t fresh = 0;
      for (std::size_t v = begin; v != end; ++v) {
        const ClusterTable::Place place = table.insert(key(v));
        if (place.inserted == ClusterTable::Inserted::fresh) ++fresh;
        if (place.inserted == ClusterTable::Inserted::full)
          return over.store(true, std::memory_order_relaxed);
        on_key(i, v, place);
      }
      if (count.fetch_add(fresh) + fresh > limit) over.store(true, std::memory_order_relaxed);
    });
  });
  return !over;
}

}  // namespace

std::optional<std::uint64_t> count_clusters(std::span<const ClusterInstance> instances,
                                            const ClusterGrid& grid, std::uint64_t limit,
                                            std::vector<std::uint32_t>* members) {
  const std::uint64_t vertices = vertex_offsets(instances).back();
  limit = std::min(limit, vertices);
  // Start with a small table, which stays in the processor's caches: clustering is useful if clusters are
  // few.
  for (std::uint64_t most = std::min(limit, vertices / 8 + 64);; most = std::min(limit, 4 * most)) {
    ClusterTable table(most);
    std::atomic<std::uint64_t> count = 0;
    std::vector<std::uint32_t> fresh(members == nullptr ? 0 : table.size());
    std::atomic<std::uint64_t> fresh_count = 0;
    const auto on_key = [&](std::size_t i, std::size_t v, const ClusterTable::Place& place) {
      if (members != nullptr && place.inserted == ClusterTable::Inserted::fresh)
        fresh[fresh_count++] = static_cast<std::uint32_t>(vertex_number(instances[i], v));
    };
    if (insert_vertices(instances, grid, most, table, count, on_key)) {
      fresh.resize(fresh_count);
      if (members != nullptr) *members = std::move(fresh);
      return count;
    }
    if (most == limit) return std::nullopt;
  }
}

std::vector<std::vector<std::uint32_t>> number_clusters(std::span<const ClusterInstance> instances,
                                                        const ClusterGrid& grid, std::uint64_t count) {
  const std::vector<std::uint64_t> offsets = vertex_offsets(instances);
  ClusterTable table(count);
  std::vector<std::atomic<std::uint64_t>> first_vertices(table.size());  // ones' complement; 0 means none
  std::vector<std::uint64_t> slots(offsets.back());
  std::atomic<std::uint64_t> found = 0;
  insert_vertices(
      instances, grid, count, table, found,
      [&](std::size_t i, std::size_t v, const ClusterTable::Place& place) {
        const std::uint64_t vertex = offsets[i] + v;
        slots[vertex] = place.slot;
        std::atomic<std::uint64_t>& first = first_vertices[place.slot];
        std::uint64_t there = first.load(std::memory_order_relaxed);
        while (~vertex > there && !first.compare_exchange_weak(there, ~vertex, std::memory_order_relaxed)) {
        }
      });
  const auto first_vertex = [&](std::uint64_t vertex) {
    return ~first_vertices[slots[vertex]].load(std::memory_order_relaxed);
  };
  std::vector<std::uint32_t> numbers(slots.size());
  const std::size_t vertices = numbers.size();
  for_each_range(vertices, kClusterGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v != end; ++v) numbers[v] = first_vertex(v) == v ? 1 : 0;
  });
  inclusive_prefix_sum(numbers);  // at a cluster's first vertex: the cluster's number plus one
  std::vector<std::vector<std::uint32_t>> result(instances.size());
  for_each(instances.size(), [&](std::size_t i) {
    result[i].resize(offsets[i + 1] - offsets[i]);
    for_each_range(result[i].size(), kClusterGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v != end; ++v) result[i][v] = numbers[first_vertex(offsets[i] + v)] - 1;
    });
  });
  return result;
}

}  // namespace gatelight::neural
