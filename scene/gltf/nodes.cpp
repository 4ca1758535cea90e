#include "scene/gltf/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scene/gltf/accessors.h"
#include "scene/gltf/model.h"
#include "scene/gltf/node_content.h"
#include "scene/gltf/visibility.h"

namespace gatelight::scene::gltf {
namespace {

using Transform = Eigen::Affine3d;

Transform local_transform(const Document& document, int index, Warnings& warnings) {
  const tinygltf::Node& node = element(document.model().nodes, index);
  const auto where = [&](const char* member) { return fmt::format("nodes[{}].{}", index, member); };
  Transform t = Transform::Identity();
  if (!node.matrix.empty()) {
    const Eigen::Matrix4d m(node.matrix.data());
    if ((m.row(3) - Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)).cwiseAbs().maxCoeff() > 1e-6) {
      document.fail(where("matrix"), fmt::format("last row {} {} {} {}, expected 0 0 0 1", m(3, 0), m(3, 1),
                                                 m(3, 2), m(3, 3)));
    }
    t.matrix().topRows<3>() = m.topRows<3>();
    return t;
  }
  t.translate(vector_or<Eigen::Vector3d>(node.translation, Eigen::Vector3d::Zero()));
  const Eigen::Quaterniond q(vector_or<Eigen::Vector4d>(node.rotation, Eigen::Vector4d::UnitW()));
  if (q.norm() > 1e-12) {
    t.rotate(q.normalized());
  } else {
    warnings.add(where("rotation") + ": 0 0 0 0, expected a unit quaternion; it is ignored");
  }
  t.scale(vector_or<Eigen::Vector3d>(node.scale, Eigen::Vector3d::Ones()));
  return t;
}

/// Whether the node itself leaves its meshes, its lights and its children visible.
bool is_visible(const tinygltf::Node& node) {
  const tinygltf::Value* const visibility = find_extension(node.extensions, "KHR_node_visibility");
  return !visibility || !visibility->Has("visible") || visibility->Get("visible").Get<bool>();
}

/// The parent of each node, or -1. Checks that each node has at most one parent and that there is no cycle.
std::vector<int> find_parents(const Document& document) {
  const std::vector<tinygltf::Node>& nodes = document.model().nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0) {
        document.fail(
            fmt::format("nodes[{}].children", i),
            fmt::format("node {} is a child of node {} already, expected one parent", child, parent));
      }
      parent = static_cast<int>(i);
    }
  }
  // Every walk towards a root marks its nodes. A mark of the same walk means a cycle.
  std::vector<std::size_t> seen(nodes.size(), 0);
  for (std::size_t start = 0; start < nodes.size(); ++start) {
    for (int i = static_cast<int>(start); i >= 0; i = parents[static_cast<std::size_t>(i)]) {
      std::size_t& mark = seen[static_cast<std::size_t>(i)];
      if (mark == start + 1) document.fail(fmt::format("nodes[{}]", i), "its own ancestor, expected a tree");
      if (mark != 0) break;
      mark = start + 1;
    }
  }
  return parents;
}

class GraphWalk {
 public:
  GraphWalk(const Document& document, const Motion& motion, bool show_hidden, const Vec3& origin,
            Warnings& warnings)
      : document_(document),
        motion_(motion),
        show_hidden_(show_hidden),
        from_file_(Eigen::Translation3d(Eigen::Vector3d::Zero() - origin.cast<double>())),
        warnings_(warnings),
        parents_(find_parents(document)) {
    graph_.joints.resize(document.model().skins.size());
    graph_.lights_move = motion.lights;
  }

  Graph walk(int scene) {
    struct Entry {
      int node;
      Transform parent;
      State state;
    };
    const std::vector<int>& roots = element(document_.model().scenes, scene).nodes;
    std::vector<Entry> stack;
    for (const int root : roots_to_show(roots, scene)) stack.push_back({root, from_file_, {}});
    std::reverse(stack.begin(), stack.end());
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      const Transform world = entry.parent * local_transform(document_, entry.node, warnings_);
      const tinygltf::Node& node = element(document_.model().nodes, entry.node);
      const State state = state_of(entry.node, entry.state);
      visit(entry.node, checked(world, fmt::format("nodes[{}]", entry.node)), state);
      for (std::size_t i = node.children.size(); i-- > 0;) {
        stack.push_back({node.children[i], world, state});
      }
    }
    return std::move(graph_);
  }

 private:
  /// What a node has of its parents, and hands on to its children.
  struct State {
    bool visible = true;
    bool moves = false;   ///< its place in the world changes with the time
    bool blinks = false;  ///< its visibility does
    double turn = 0.0;    ///< Placement::turn
  };

  State state_of(int index, const State& parent) const {
    const NodeMotion& motion = element(motion_.nodes, index);
    return {parent.visible && (show_hidden_ || is_visible(element(document_.model().nodes, index))),
            parent.moves || motion.place, parent.blinks || (motion.visibility && !show_hidden_),
            parent.turn + motion.turn};
  }

  bool moves(int node) const {
    for (int i = node; i >= 0; i = parents_[static_cast<std::size_t>(i)]) {
      if (element(motion_.nodes, i).place) return true;
    }
    return false;
  }

  double turn_of(int node) const {
    double turn = 0.0;
    for (int i = node; i >= 0; i = parents_[static_cast<std::size_t>(i)])
      turn += element(motion_.nodes, i).turn;
    return turn;
  }

  /// The listed nodes without repetitions and without those that are shown below another.
  std::vector<int> roots_to_show(const std::vector<int>& listed, int scene) {
    std::vector<char> is_listed(parents_.size(), 0);
    for (const int root : listed) is_listed[static_cast<std::size_t>(root)] = 1;
    std::vector<char> is_taken(parents_.size(), 0);
    std::vector<int> shown;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const std::size_t root = static_cast<std::size_t>(listed[i]);
      const auto warn = [&](const char* what) {
        warnings_.add(fmt::format("scenes[{}].nodes[{}]: node {} {}", scene, i, root, what));
      };
      bool below = false;
      for (int p = parents_[root]; p >= 0 && !below; p = parents_[static_cast<std::size_t>(p)])
        below = is_listed[static_cast<std::size_t>(p)] != 0;
      if (is_taken[root]) {
        warn("is listed twice; it is shown once");
      } else if (below) {
        warn("is not a root; it is shown as a child");
      } else {
        if (parents_[root] >= 0) warn("is not a root; it is shown without its parent");
        shown.push_back(listed[i]);
      }
      is_taken[root] = 1;
    }
    return shown;
  }

  const Transform& checked(const Transform& t, std::string_view where) const {
    if (!t.matrix().cast<float>().allFinite()) {
      document_.fail(where, "a world transform that is not finite, expected finite numbers");
    }
    return t;
  }

  /// A node that is not visible shows neither meshes nor lights; cameras stay (KHR_node_visibility). Those
  /// that are hidden for a while keep their places in the lists.
  void visit(int index, const Transform& world, const State& state) {
    const tinygltf::Node& node = element(document_.model().nodes, index);
    if ((state.visible || state.blinks) && node.mesh >= 0) place_mesh(index, node, world, state);
    if (node.camera >= 0) {
      graph_.cameras.push_back(make_camera(document_, index, world));
      graph_.camera_turn = std::max(graph_.camera_turn, state.turn);
    }
    const tinygltf::Value* light = find_extension(node.extensions, "KHR_lights_punctual");
    if (!light) return;
    graph_.lights_move |= state.moves || state.blinks || element(motion_.nodes, index).seen_by;
    if (!state.visible && !state.blinks) return;
    std::optional<PunctualLight> made =
        make_light(document_, index, integer_or(*light, "light", 0), world, warnings_);
    if (!made) return;
    if (!state.visible) made->intensity.setZero();
    made->rays = seen_by(index, node, kBounceRays).rays;
    graph_.lights.push_back(*std::move(made));
    graph_.light_nodes.push_back(index);
    graph_.light_turns.push_back(state.turn);
  }

  /// Of the node's own object or lamp, to which only the rays of `needed` matter.
  Visibility seen_by(int index, const tinygltf::Node& node, RayKinds needed) {
    const Visibility visibility = read_visibility(node.extensions);
    // What changes over time may be unseen for a while.
    if ((visibility.rays & needed) == 0 && !element(motion_.nodes, index).seen_by) {
      const char* const what = needed == kAllRays ? "no ray sees the mesh" : "the light lights nothing";
      warnings_.add(fmt::format("nodes[{}].extensions.{}: {}", index, kVisibilityExtension, what));
    }
    return visibility;
  }

  void place_mesh(int index, const tinygltf::Node& node, const Transform& world, const State& state) {
    const tinygltf::Mesh& mesh = element(document_.model().meshes, node.mesh);
    Placement placement;
    placement.pose = pose_of(index, node, mesh);
    placement.node = index;
    // In glTF only the joints place a skinned mesh.
    const bool skinned = graph_.poses[static_cast<std::size_t>(placement.pose)].skin >= 0;
    const Transform base = skinned ? Transform::Identity() : world;
    placement.moves = (!skinned && state.moves) || state.blinks || element(motion_.nodes, index).seen_by ||
                      graph_.deforming[static_cast<std::size_t>(placement.pose)] != 0;
    placement.hidden = !state.visible;
    placement.visibility = seen_by(index, node, kAllRays);
    placement.turn = skinned ? 0.0 : state.turn;
    placement.name = node.name.empty() ? mesh.name : node.name;
    if (placement.name.empty()) placement.name = fmt::format("node {}", index);
    placement.dielectric_priority = dielectric_priority(index, node);
    if (const tinygltf::Value* instancing = find_extension(node.extensions, "EXT_mesh_gpu_instancing")) {
      const std::string where = fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing", index);
      const std::map<std::string, int> attributes = instance_attributes(*instancing);
      claim_instances(attributes, mesh, where);
      if (attributes.empty()) {
        warnings_.add(where + ": no attribute gives the number of instances; the mesh is shown once");
        add(placement, base);
      }
      for (const Transform& t : read_instances(document_, attributes, where, warnings_)) {
        add(placement, checked(skinned ? from_file_ * t * from_file_.inverse() : base * t, where));
      }
    } else {
      add(std::move(placement), base);
    }
  }

  /// Called before the instances are allocated: a huge count needs only a few characters.
  void claim_instances(const std::map<std::string, int>& attributes, const tinygltf::Mesh& mesh,
                       const std::string& where) {
    std::size_t count = 0;
    for (const auto& [semantic, accessor] : attributes) {
      count = std::max(count, element(document_.model().accessors, accessor).count);
    }
    document_.claim(count * (sizeof(Transform) + sizeof(Placement) + mesh.name.size()), where);
  }

  /// The number of the node's pose.
  int pose_of(int index, const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
    const bool morphs = element(motion_.nodes, index).weights;
    Pose pose{node.mesh, node.weights.empty() ? mesh.weights : node.weights, node.skin, morphs ? index : -1};
    if (std::all_of(pose.weights.begin(), pose.weights.end(), [](double w) { return w == 0.0; }))
      pose.weights.clear();
    if (pose.skin >= 0) {
      if (element(document_.model().skins, pose.skin).joints.empty()) {
        warnings_.add("a skin without joints is ignored");
        pose.skin = -1;
      } else {
        load_joints(pose.skin);
      }
    }
    const auto [entry, is_new] = pose_numbers_.try_emplace(pose, static_cast<int>(graph_.poses.size()));
    if (is_new) {
      graph_.deforming.push_back(morphs || (pose.skin >= 0 && bends(pose.skin)) ? 1 : 0);
      graph_.pose_turns.push_back(pose.skin >= 0 ? turn_of_joints(pose.skin) : 0.0);
      graph_.poses.push_back(std::move(pose));
    }
    return entry->second;
  }

  bool bends(int skin) const {
    const std::vector<int>& joints = element(document_.model().skins, skin).joints;
    return std::any_of(joints.begin(), joints.end(), [this](int joint) { return moves(joint); });
  }

  double turn_of_joints(int skin) const {
    double turn = 0.0;
    if (!motion_.turns) return turn;
    for (const int joint : element(document_.model().skins, skin).joints)
      turn = std::max(turn, turn_of(joint));
    return turn;
  }

  void load_joints(int index) {
    std::vector<JointMatrix>& joints = graph_.joints[static_cast<std::size_t>(index)];
    if (!joints.empty()) return;
    const tinygltf::Skin& skin = element(document_.model().skins, index);
    const std::string where = fmt::format("skins[{}]", index);
    document_.claim(skin.joints.size() * (sizeof(Transform) + sizeof(JointMatrix)), where);
    const std::vector<Transform> inverses =
        read_inverse_bind_matrices(document_, skin.inverseBindMatrices, skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      const Transform joint = world_of(skin.joints[i]) * inverses[i];
      joints.push_back(checked(joint, where).matrix().topRows<3>().cast<float>());
    }
  }

  /// The node's transform to the world, kept for its descendants.
  const Transform& world_of(int node) {
    worlds_.resize(parents_.size());
    std::vector<int> unknown;
    for (int i = node; i >= 0 && !worlds_[static_cast<std::size_t>(i)];
         i = parents_[static_cast<std::size_t>(i)]) {
      unknown.push_back(i);
    }
    for (std::size_t k = unknown.size(); k-- > 0;) {
      const int parent = parents_[static_cast<std::size_t>(unknown[k])];
      Transform local = local_transform(document_, unknown[k], warnings_);
      worlds_[static_cast<std::size_t>(unknown[k])] =
          parent < 0 ? local.pretranslate(from_file_.translation())
                     : *worlds_[static_cast<std::size_t>(parent)] * local;
    }
    return *worlds_[static_cast<std::size_t>(node)];
  }

  /// An application's own number, which modelling programs write as a custom property of the object.
  float dielectric_priority(int index, const tinygltf::Node& node) const {
    constexpr const char* kName = "dielectric_priority";
    if (!node.extras.Has(kName)) return 0.0f;
    const tinygltf::Value& value = node.extras.Get(kName);
    const float priority = value.IsNumber() ? static_cast<float>(value.GetNumberAsDouble()) : kInfinity;
    if (std::isfinite(priority)) return priority;
    warnings_.add(
        fmt::format("nodes[{}].extras.{}: {}, expected a finite number; 0 is used", index, kName,
                    value.IsString() ? value.Get<std::string>() : fmt::format("{}", value.Get<double>())));
    return 0.0f;
  }

  void add(Placement placement, const Transform& t) {
    placement.transform = t;
    // Some files hide meshes by scaling them to a line or a point. Such a mesh is invisible, and no ray can
    // be transformed into its space.
    const Affine single = rounded(t);
    const Eigen::Matrix3f linear = single.linear();
    const bool nothing = normal_matrix(single).isZero(0.0f) || linear.isZero(0.0f);
    if (nothing && !placement.moves) {
      warnings_.add("meshes with a scale of 0 are ignored");
      return;
    }
    if (nothing) {
      placement.hidden = true;
      placement.transform.linear().setIdentity();
    }
    graph_.placements.push_back(std::move(placement));
  }

  const Document& document_;
  const Motion& motion_;
  bool show_hidden_;
  Transform from_file_;  ///< from the file's coordinates to the world
  Warnings& warnings_;
  std::vector<int> parents_;
  std::vector<std::optional<Transform>> worlds_;  ///< of nodes; empty where they are not known yet
  std::map<Pose, int> pose_numbers_;
  Graph graph_;
};

}  // namespace

Graph flatten_nodes(const Document& document, const Motion& motion, const LoadOptions& options,
                    const Vec3& origin, Warnings& warnings) {
  const std::size_t count = document.model().scenes.size();
  if (options.scene >= 0 && static_cast<std::size_t>(options.scene) >= count) {
    document.fail("scenes", fmt::format("scene {} requested, expected less than {}", options.scene, count));
  }
  GraphWalk graph_walk(document, motion, options.show_hidden, origin, warnings);
  if (count == 0) {
    warnings.add("the file has no scene");
    return {};
  }
  return graph_walk.walk(shown_scene(document.model(), options.scene));
}

}  // namespace gatelight::scene::gltf
