#include "neural/layout/clusters.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include "neural/random.h"

namespace gatelight::neural {

namespace {

constexpr std::size_t kGrain = 4096;
using Range = tbb::blocked_range<std::size_t>;

/// Cell boundaries lie off the multiples of the cell: planes at round coordinates, and their rounding errors,
/// do not fall on one.
constexpr double kGridShift = 0.3819660112501051;

/// An axis is dominant over the ones before it only by this factor: normals between two axes, up to rounding,
/// fall to one of them.
constexpr double kAxisMargin = 1.0 + 1.0 / 64;

/// 0 .. 5: axis and sign.
std::uint64_t facing(const Double3& normal) {
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (std::abs(normal[c]) > kAxisMargin * std::abs(normal[axis])) axis = c;
  return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
}

/// Cells are numbers in double precision, whatever their magnitude, and stay so until they are hashed. That
/// two keys of n have the same hash, which merges their clusters, has a probability of n^2 / 2^65.
class ClusterKeys {
 public:
  ClusterKeys(const ClusterInstance& instance, const ClusterGrid& grid)
      : instance_(instance),
        cell_(grid.cell * instance.cell_scale),
        normals_(grid.normals),
        scale_key_(mix_bits(std::bit_cast<std::uint64_t>(instance.cell_scale))),
        normals_to_world_(cofactors(instance.object_to_world)) {}

  std::uint64_t operator()(std::size_t vertex) const {
    const MeshTopology& topology = *instance_.topology;
    const Double3 position = transform_point(instance_.object_to_world,
                                             to_double(instance_.mesh->positions[topology.vertices[vertex]]));
    std::uint64_t key = scale_key_;
    if (normals_) key = mix_bits(key ^ facing(transform_vector(normals_to_world_, topology.normals[vertex])));
    for (const double coordinate : position) {
      const double cell = std::floor(coordinate / cell_ + kGridShift);
      key = mix_bits(key ^ std::bit_cast<std::uint64_t>(cell + 0.0));  // -0 becomes 0
    }
    return key == 0 ? 1 : key;
  }

 private:
  const ClusterInstance& instance_;
  double cell_;
  bool normals_;
  std::uint64_t scale_key_;
  Transform normals_to_world_;
};

/// The index of each instance's first vertex among all.
std::vector<std::uint64_t> vertex_offsets(std::span<const ClusterInstance> instances) {
  std::vector<std::uint64_t> offsets(instances.size() + 1, 0);
  for (std::size_t i = 0; i < instances.size(); ++i)
    offsets[i + 1] = offsets[i] + instances[i].topology->vertices.size();
  return offsets;
}

/// False where the table is full or more than `limit` keys are in it.
bool insert_vertices(std::span<const ClusterInstance> instances, const ClusterGrid& grid, std::uint64_t limit,
                     ClusterTable& table, std::atomic<std::uint64_t>& count) {
  const std::vector<std::uint64_t> offsets = vertex_offsets(instances);
  std::atomic<bool> over = false;
  tbb::parallel_for(std::size_t{0}, instances.size(), [&](std::size_t i) {
    const ClusterKeys key(instances[i], grid);
    tbb::parallel_for(Range(0, instances[i].topology->vertices.size(), kGrain), [&](const Range& range) {
      if (over.load(std::memory_order_relaxed)) return;
      std::uint64_t fresh = 0;
      for (std::size_t v = range.begin(); v != range.end(); ++v) {
        const ClusterTable::Inserted inserted = table.insert(key(v), offsets[i] + v);
        if (inserted == ClusterTable::Inserted::fresh) ++fresh;
        if (inserted == ClusterTable::Inserted::full) return over.store(true, std::memory_order_relaxed);
      }
      if (count.fetch_add(fresh) + fresh > limit) over.store(true, std::memory_order_relaxed);
    });
  });
  return !over;
}

}  // namespace

std::optional<std::uint64_t> count_clusters(std::span<const ClusterInstance> instances,
                                            const ClusterGrid& grid, std::uint64_t limit) {
  limit = std::min(limit, vertex_offsets(instances).back());
  ClusterTable table(limit);
  std::atomic<std::uint64_t> count = 0;
  if (!insert_vertices(instances, grid, limit, table, count)) return std::nullopt;
  return count;
}

ClusterTable number_clusters(std::span<const ClusterInstance> instances, const ClusterGrid& grid,
                             std::uint64_t count) {
  ClusterTable table(count);
  std::atomic<std::uint64_t> found = 0;
  insert_vertices(instances, grid, count, table, found);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> order;  // first vertex, slot
  order.reserve(count);
  for (std::size_t s = 0; s < table.slots().size(); ++s)
    if (table.slots()[s].key != 0) order.emplace_back(table.slots()[s].value, s);
  tbb::parallel_sort(order.begin(), order.end());
  tbb::parallel_for(std::size_t{0}, order.size(),
                    [&](std::size_t number) { table.slots()[order[number].second].value = number; });
  return table;
}

std::vector<std::uint32_t> vertex_clusters(const ClusterInstance& instance, const ClusterGrid& grid,
                                           const ClusterTable& numbers) {
  const ClusterKeys key(instance, grid);
  std::vector<std::uint32_t> clusters(instance.topology->vertices.size());
  tbb::parallel_for(Range(0, clusters.size(), kGrain), [&](const Range& range) {
    for (std::size_t v = range.begin(); v != range.end(); ++v)
      clusters[v] = static_cast<std::uint32_t>(numbers.value(key(v)));
  });
  return clusters;
}

}  // namespace gatelight::neural
