#include "scene/coincident_instances.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace gatelight::scene {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr std::uint32_t kSeveral = ~0u;
constexpr std::uint32_t kBlock = 256;  // triangles

/// Of a ray, over the largest coordinate (renderer/surface/rounding.h).
constexpr float kOffset = 16.0f * 0x1p-23f;

/// Beyond this many triangles that let light pass, as leaves do, none is compared.
constexpr std::size_t kMaxPassing = std::size_t{1} << 22;

Triangle corners_of(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  const std::array<Vec3, 3> p = world_triangle(scene, instance, primitive);
  return {p[0].cast<double>(), p[1].cast<double>(), p[2].cast<double>()};
}

Box box_of(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  Box box;
  const Mesh& mesh = scene.mesh_of(instance);
  for (const std::uint32_t corner : mesh.triangles[primitive]) {
    const Vec3& p = mesh.positions[corner];
    box.extend(instance.baked ? p : Vec3(instance.transform * p));
  }
  return box;
}

/// The front's, and as long as twice the area.
Eigen::Vector3d front_of(const Triangle& t, const Instance& instance) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  return instance.swaps_handedness ? Eigen::Vector3d(-n) : n;
}

/// Whether the projections onto the plane perpendicular to `axis` overlap by more than their edges.
bool overlap(const Triangle& a, const Triangle& b, Eigen::Index axis, double tolerance) {
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  for (const Triangle* t : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d edge = (*t)[(k + 1) % 3] - (*t)[k];
      const Eigen::Vector2d across = Eigen::Vector2d(-edge[y], edge[x]).stableNormalized();
      double low[2], high[2];
      for (const auto& [triangle, i] : {std::pair(&a, 0), std::pair(&b, 1)}) {
        low[i] = kInfinity;
        high[i] = -kInfinity;
        for (const Eigen::Vector3d& p : *triangle) {
          const double place = across.x() * p[x] + across.y() * p[y];
          low[i] = std::min(low[i], place);
          high[i] = std::max(high[i], place);
        }
      }
      if (!(std::min(high[0], high[1]) - std::max(low[0], low[1]) > tolerance)) return false;
    }
  }
  return true;
}

/// Whether the triangles lie in one plane, up to the tolerance in metres, and overlap there.
bool coincide(const Triangle& a, const Eigen::Vector3d& front_a, const Triangle& b,
              const Eigen::Vector3d& front_b, double tolerance) {
  const bool larger = front_a.squaredNorm() > front_b.squaredNorm();
  const Eigen::Vector3d n = (larger ? front_a : front_b).stableNormalized();
  const Triangle &plane = larger ? a : b, &other = larger ? b : a;
  for (const Eigen::Vector3d& p : other) {
    if (!(std::abs(n.dot(p - plane[0])) <= tolerance)) return false;
  }
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return overlap(a, b, axis, tolerance);
}

/// Finds the triangles of some instances in a box.
class PassingTriangles {
 public:
  struct Item {
    Box box;
    std::uint32_t instance, primitive;
  };

  explicit PassingTriangles(std::vector<Item> items) : items_(std::move(items)) {
    std::size_t depth = 0;
    while (items_.size() >> depth > kLeaf) ++depth;
    nodes_.resize((std::size_t{2} << depth) - 1);
    build(0, 0, items_.size());
  }

  /// Calls visit(item) for those whose boxes intersect this one, but for those of the instance.
  template <class Visit>
  void each_in(const Box& box, std::uint32_t but, const Visit& visit) const {
    each_node_in(box, but, [&](const Node& node) {
      if (!is_leaf(node)) return true;
      for (const Item& item : std::span(items_).subspan(node.begin, node.end - node.begin)) {
        if (item.instance != but && item.box.intersects(box)) visit(item);
      }
      return false;
    });
  }

  /// A bound of all that each_in() visits.
  Box bounds_in(const Box& box, std::uint32_t but) const {
    Box bounds;
    each_node_in(box, but, [&](const Node& node) {
      const bool whole = box.contains(node.box);
      if (whole || is_leaf(node)) bounds.extend(whole ? node.box : node.box.intersection(box));
      return !whole;
    });
    return bounds;
  }

 private:
  static constexpr std::size_t kLeaf = 16;

  /// A complete tree: the children of node k are 2 k + 1 and 2 k + 2.
  struct Node {
    Box box;
    std::uint32_t instance = kSeveral;  ///< of all items; or kSeveral
    std::size_t begin = 0, end = 0;     ///< its items
  };

  std::size_t number_of(const Node& node) const { return static_cast<std::size_t>(&node - nodes_.data()); }
  bool is_leaf(const Node& node) const { return 2 * number_of(node) + 1 >= nodes_.size(); }

  /// Calls visit(node) for nodes that intersect the box; those below follow if it returns true.
  template <class Visit>
  void each_node_in(const Box& box, std::uint32_t but, const Visit& visit) const {
    std::size_t waiting[64], count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[waiting[--count]];
      if (node.instance == but || !node.box.intersects(box) || !visit(node) || is_leaf(node)) continue;
      const std::size_t child = 2 * number_of(node) + 1;
      waiting[count++] = child + 1;
      waiting[count++] = child;
    }
  }

  void build(std::size_t number, std::size_t begin, std::size_t end) {
    constexpr std::size_t kParallel = 2048;
    Node& node = nodes_[number];
    node.begin = begin;
    node.end = end;
    node.instance = items_[begin].instance;
    Box middles;
    for (std::size_t i = begin; i < end; ++i) {
      node.box.extend(items_[i].box);
      middles.extend(items_[i].box.center());
      if (items_[i].instance != node.instance) node.instance = kSeveral;
    }
    if (is_leaf(node)) return;
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::size_t middle = (begin + end) / 2;
    const auto item = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(item(begin), item(middle), item(end), [axis](const Item& a, const Item& b) {
      return a.box.center()[axis] < b.box.center()[axis];
    });
    const auto first = [&] { build(2 * number + 1, begin, middle); };
    const auto second = [&] { build(2 * number + 2, middle, end); };
    if (end - begin > kParallel) return tbb::parallel_invoke(first, second);
    first();
    second();
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

using Pairs = std::map<InstancePair, Facing>;

class CoincidenceSearch {
 public:
  explicit CoincidenceSearch(const Scene& scene) : scene_(scene) {}

  CoincidentInstances find() {
    const std::vector<Instance>& instances = scene_.instances;
    const auto count = static_cast<std::uint32_t>(instances.size());
    result_.offsets.resize(count);
    std::vector<Box> boxes(count);
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
      Box& box = boxes[i];
      const Instance& instance = instances[i];
      for (const Vec3& p : scene_.mesh_of(instance).positions)
        box.extend(instance.baked ? p : Vec3(instance.transform * p));
      if (box.isEmpty()) return;
      const float largest = std::max({box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff(),
                                      instance.transform.translation().cwiseAbs().maxCoeff()});
      result_.offsets[i] = kOffset * largest;
      const Vec3 margin = Vec3::Constant(result_.offsets[i]);
      box = Box(box.min() - margin, box.max() + margin);
    });
    std::vector<PassingTriangles::Item> items;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!lets_light_pass(scene_, instances[i])) continue;
      const Vec3 margin = Vec3::Constant(result_.offsets[i]);
      for (std::uint32_t t = 0; t < scene_.mesh_of(instances[i]).triangles.size(); ++t) {
        const Box box = box_of(scene_, instances[i], t);
        items.push_back({Box(box.min() - margin, box.max() + margin), i, t});
      }
    }
    const PassingTriangles triangles(std::move(items));
    tbb::enumerable_thread_specific<Pairs> found;
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
      const Mesh& mesh = scene_.mesh_of(instances[i]);
      if (mesh.deforming >= 0) return;
      if (triangles.bounds_in(boxes[i], i).isEmpty()) return;
      const auto end = static_cast<std::uint32_t>(mesh.triangles.size());
      tbb::parallel_for(std::uint32_t{0}, (end + kBlock - 1) / kBlock, [&](std::uint32_t block) {
        const std::uint32_t first = block * kBlock;
        compare(triangles, i, first, std::min(first + kBlock, end), found.local());
      });
    });
    for (const Pairs& some : found) {
      for (const auto& [pair, facing] : some) {
        result_.pairs[pair].same |= facing.same;
        result_.pairs[pair].opposite |= facing.opposite;
      }
    }
    return std::move(result_);
  }

 private:
  /// Compares the triangles [first, end) of an instance. Most are far from all that let light pass, and
  /// neighbours in the file are often neighbours in space, so they are looked up together first.
  void compare(const PassingTriangles& triangles, std::uint32_t i, std::uint32_t first, std::uint32_t end,
               Pairs& found) const {
    const Instance& instance = scene_.instances[i];
    const Vec3 margin = Vec3::Constant(result_.offsets[i]);
    Box all;
    for (std::uint32_t t = first; t < end; ++t) all.extend(box_of(scene_, instance, t));
    const Box near = triangles.bounds_in(Box(all.min() - margin, all.max() + margin), i);
    if (near.isEmpty()) return;
    for (std::uint32_t t = first; t < end; ++t) {
      Box box = box_of(scene_, instance, t);
      box = Box(box.min() - margin, box.max() + margin);
      if (box.intersects(near)) compare(triangles, i, t, box, found);
    }
  }

  void compare(const PassingTriangles& triangles, std::uint32_t i, std::uint32_t t, const Box& box,
               Pairs& found) const {
    const Instance& instance = scene_.instances[i];
    triangles.each_in(box, i, [&](const PassingTriangles::Item& item) {
      const Triangle a = corners_of(scene_, scene_.instances[item.instance], item.primitive);
      const Triangle b = corners_of(scene_, instance, t);
      const Eigen::Vector3d front_a = front_of(a, scene_.instances[item.instance]),
                            front_b = front_of(b, instance);
      const bool same = front_a.dot(front_b) > 0.0;
      const auto known = found.find({item.instance, i});
      if (known != found.end() && (same ? known->second.same : known->second.opposite)) return;
      if (!coincide(a, front_a, b, front_b,
                    static_cast<double>(result_.offsets[item.instance] + result_.offsets[i])))
        return;
      Facing& facing = found[{item.instance, i}];
      (same ? facing.same : facing.opposite) = true;
    });
  }

  const Scene& scene_;
  CoincidentInstances result_;
};

}  // namespace

bool lets_light_pass(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = scene.mesh_of(instance);
  const Material& material = scene.material_of(instance);
  return material.transmits() && !material.culled && mesh.deforming < 0 && !mesh.triangles.empty();
}

CoincidentInstances find_coincident_instances(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) {
    if (lets_light_pass(scene, instance)) count += scene.mesh_of(instance).triangles.size();
  }
  if (count == 0 || count > kMaxPassing) return {};
  return CoincidenceSearch(scene).find();
}

}  // namespace gatelight::scene
