#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/platform/memory.h"
#include "base/platform/threads.h"
#include "scene/bake.h"
#include "scene/coincident_emitters.h"
#include "scene/finish.h"
#include "scene/gltf.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/appearance.h"
#include "scene/gltf/document.h"
#include "scene/gltf/image_light.h"
#include "scene/gltf/load_each.h"
#include "scene/gltf/model.h"
#include "scene/gltf/motion.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/parts.h"
#include "scene/gltf/primitives.h"
#include "scene/gltf/shutter_states.h"
#include "scene/gltf/shutter_times.h"
#include "scene/gltf/visibility.h"
#include "scene/shutter.h"

namespace gatelight::scene {
namespace gltf {
namespace {

/// The origin of Scene::origin: the scene's centre if that is far away, else zero. Boxes: of the parts.
Vec3 choose_origin(const Graph& graph, const Parts& parts, const std::vector<Box>& boxes) {
  Eigen::AlignedBox3d bounds;
  for (const Placement& placement : graph.placements) {
    parts.for_each_of(placement.pose, [&](std::size_t i) {
      if (boxes[i].isEmpty()) return;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = boxes[i].corner(static_cast<Box::CornerType>(corner));
        bounds.extend(placement.transform * p.cast<double>());
      }
    });
  }
  if (bounds.isEmpty()) return Vec3::Zero();
  const double radius = 0.5 * bounds.diagonal().norm();
  if (!(bounds.center().norm() > kFarFromOrigin * radius)) return Vec3::Zero();
  // The centre is rounded so that single precision holds it exactly.
  const Eigen::Vector3d center = bounds.center();
  const double step = std::exp2(std::ceil(std::log2(center.cwiseAbs().maxCoeff())) - 23.0);
  const Eigen::Vector3d origin = (center / step).array().round() * step;
  return origin.cast<float>();
}

/// A ray must be transformable into the space of an instance that moves: a flat one gets a little thickness.
void thicken(Affine& transform) {
  constexpr float kThinnest = 1e-5f;
  if (!is_flat(transform)) return;
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(transform.linear(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 sizes = svd.singularValues().cwiseMax(kThinnest * svd.singularValues()[0]);
  Eigen::Matrix3f turn = svd.matrixU() * svd.matrixV().transpose();
  transform.linear() = turn * svd.matrixV() * sizes.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

class Loader {
 public:
  Loader(const std::filesystem::path& path, const LoadOptions& options)
      : options_(options),
        path_(path.string()),
        document_(path, options, warnings_),
        appearance_(document_) {}

  /// The scene before finish().
  Scene read() {
    Scene scene;
    scene.path = path_;
    scene.animations = document_.animations();
    scene.variants = variant_names(document_);
    const std::vector<std::string>& extensions = document_.model().extensionsUsed;
    if (std::find(extensions.begin(), extensions.end(), "VRM") != extensions.end()) scene.front = -1.0f;
    const int variant =
        options_.variant.empty() ? -1 : find_variant(document_, scene.variants, options_.variant);
    motion_ = find_motion(document_);
    Graph graph = flatten_nodes(document_, motion_, options_, scene.origin, warnings_);
    parts_.emplace(document_, graph, variant);
    appearance_.load_materials(parts_->materials(), options_, scene, warnings_);
    parts_->claim(document_, graph, options_.bake_transforms);
    scene.meshes.resize(parts_->size());
    load_meshes(graph, scene, [](const Pose&) { return true; });
    move_to_origin(graph, scene);
    place(graph, scene);
    scene.cameras = graph.cameras;
    scene.lights = graph.lights;
    appearance_.load_images(options_, scene, warnings_);
    take_image_light(scene);
    take_visibility(graph, scene);
    scene.motion = {.instances = std::any_of(scene.instances.begin(), scene.instances.end(),
                                             [](const Instance& i) { return i.moves; }),
                    .lights = graph.lights_move,
                    .image_light = motion_.image_light,
                    .materials = motion_.materials};
    scene.warnings = warnings_.take();
    return scene;
  }

  void finish(Scene& scene) {
    apply_visibility(scene, options_.visibility);
    culled_copies_ = finish_geometry(scene, options_.bake_transforms);
    check_bounds(scene, scene.bounds);
    take_links(scene);
    adjust(scene);
    link_lights(scene, options_.light_links);
    if (options_.time) show(scene, *options_.time);
  }

  void show(Scene& scene, double seconds) {
    warnings_ = {};
    for (const std::string& warning : scene.warnings) warnings_.add(warning);
    if (!animator_) animator_.emplace(document_, warnings_);
    open_shutter(scene, seconds);
    animator_->apply(seconds, warnings_);
    const Graph graph = flatten_again(scene);
    scene.cameras = graph.cameras;
    if (scene.motion.lights || scene.motion.materials) {  // adjust() wants both as the file has them
      replace_lights(graph, scene);
      appearance_.load_materials(parts_->materials(), options_, scene, warnings_);
      appearance_.load_images(options_, scene, warnings_);
      for (const int original : culled_copies_) add_culled_copy(scene, original);
      adjust(scene);
    }
    if (scene.motion.image_light) take_image_light(scene);
    if (scene.motion.instances) move_instances(graph, scene);
    apply_visibility_again(scene, options_.visibility);
    for (std::size_t i = 0; i < scene.shutter.transforms.size(); ++i) {
      const std::vector<Affine>& states = scene.shutter.transforms[i];
      Instance& instance = scene.instances[i];
      if (!instance.hidden || states.empty()) continue;
      instance.hidden = false;
      instance.transform = transform_at(states, kShutterMiddle);
    }
    scene.warnings = warnings_.take();
  }

 private:
  Mesh load_part(const Graph& graph, std::size_t i, const Scene& scene, Warnings& warnings) const {
    const MeshPart& part = (*parts_)[i];
    const Pose& pose = element(graph.poses, part.pose);
    std::span<const JointMatrix> joints;
    if (pose.skin >= 0) joints = element(graph.joints, pose.skin);
    Mesh mesh = load_primitive(document_, pose, part.primitive, joints,
                               scene.materials[static_cast<std::size_t>(part.material)], warnings);
    mesh.material = part.material;
    if (element(graph.deforming, part.pose)) mesh.deforming = static_cast<int>(i);
    return mesh;
  }

  /// The nodes with the model's present values. It has claimed the memory of its nodes before.
  Graph flatten_again(const Scene& scene) {
    const std::size_t claimed = document_.claimed();
    Graph graph = flatten_nodes(document_, motion_, options_, scene.origin, warnings_);
    document_.return_to(claimed);
    return graph;
  }

  /// Those whose poses are chosen.
  template <typename Choice>
  void load_meshes(const Graph& graph, Scene& scene, const Choice& chosen) {
    load_each(
        parts_->size(),
        [&](std::size_t i, Warnings& warnings) {
          if (chosen(element(graph.poses, (*parts_)[i].pose)))
            scene.meshes[i] = load_part(graph, i, scene, warnings);
        },
        warnings_);
  }

  /// Sets the origin, and takes what lies in the world anew if that is not the file's.
  void move_to_origin(Graph& graph, Scene& scene) {
    std::vector<Box> boxes(parts_->size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (const Vec3& p : scene.meshes[i].positions) boxes[i].extend(p);
    }
    scene.origin = choose_origin(graph, *parts_, boxes);
    if (scene.origin.isZero(0.0f)) return;
    graph = flatten_again(scene);
    load_meshes(graph, scene, [](const Pose& pose) { return pose.skin >= 0; });
  }

  void place(const Graph& graph, Scene& scene) {
    for (const Placement& placement : graph.placements) {
      parts_->for_each_of(placement.pose, [&](std::size_t i) {
        if (scene.meshes[i].triangles.empty()) return;
        Instance instance;
        instance.name = placement.name;
        instance.mesh = static_cast<int>(i);
        instance.placement = static_cast<int>(&placement - graph.placements.data());
        instance.dielectric_priority = placement.dielectric_priority;
        instance.moves = placement.moves;
        put(placement, instance);
        scene.instances.push_back(std::move(instance));
      });
    }
    drop_unused_meshes(scene);
  }

  static void put(const Placement& placement, Instance& instance) {
    instance.hidden = placement.hidden;
    instance.visibility = placement.visibility;
    instance.transform = rounded(placement.transform);
    // Computed in double: the product of three small scales would underflow in single precision.
    instance.swaps_handedness = instance.transform.linear().cast<double>().determinant() < 0.0;
    if (instance.moves) thicken(instance.transform);
  }

  void move_instances(const Graph& graph, Scene& scene) {
    load_each(
        scene.meshes.size(),
        [&](std::size_t m, Warnings& warnings) {
          Mesh& mesh = scene.meshes[m];
          if (mesh.deforming >= 0)
            mesh = load_part(graph, static_cast<std::size_t>(mesh.deforming), scene, warnings);
        },
        warnings_);
    Box bounds;
    for (Instance& instance : scene.instances) {
      if (!instance.moves) continue;
      put(element(graph.placements, instance.placement), instance);
      for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
    }
    check_bounds(scene, bounds);
  }

  /// Fills the scene's shutter, for the time in its middle.
  void open_shutter(Scene& scene, double seconds) {
    scene.shutter = {};
    if (!(options_.shutter > 0.0)) return;
    const ShutterTimes times(*animator_, seconds, options_.shutter, warnings_);
    times.note_turns(*animator_, motion_, warnings_);
    ShutterStates states(scene, flatten_again(scene), *parts_, times);
    require_memory(states.bytes());
    for (const int division : states.divisions()) {
      for (int k = 0; k <= division * times.intervals(); ++k) {
        const ShutterTimes::Moment moment = times.moment(k, division);
        animator_->apply(moment.seconds, warnings_, moment.before);
        add_states(scene, division, states);
      }
    }
    scene.shutter = states.finish();
  }

  /// Those at the model's present time.
  void add_states(const Scene& scene, int division, ShutterStates& states) {
    const Graph graph = flatten_again(scene);
    states.add(graph, division);
    if (!scene.motion.instances) return;
    load_each(
        scene.meshes.size(),
        [&](std::size_t m, Warnings& warnings) {
          if (states.wants_vertices(m, division))
            states.add_vertices(
                m, load_part(graph, static_cast<std::size_t>(scene.meshes[m].deforming), scene, warnings));
        },
        warnings_);
    Box bounds;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const bool moves = states.wants_transform(i, division);
      if (moves) {
        Instance instance = scene.instances[i];
        put(element(graph.placements, instance.placement), instance);
        states.add_transform(i, instance);
      }
      if (moves || states.wants_vertices(static_cast<std::size_t>(scene.instances[i].mesh), division))
        bounds.extend(states.bounds(i));
    }
    check_bounds(scene, bounds);
  }

  void require_memory(std::size_t bytes) const {
    const MemoryRoom room = memory_room();
    if (bytes > room.bytes)
      throw OutOfMemory(fmt::format("{}: motion while the shutter is open needs {} MiB, and {} leaves {} MiB",
                                    path_, bytes >> 20, room.limit, room.bytes >> 20));
  }

  void take_image_light(Scene& scene) {
    if (document_.model().scenes.empty()) return;
    const int shown = shown_scene(document_.model(), options_.scene);
    scene.image_light = load_image_light(document_, shown, options_.missing_is_error, warnings_);
  }

  void take_visibility(const Graph& graph, Scene& scene) {
    for (const Placement& placement : graph.placements) nodes_.placements.push_back(placement.node);
    nodes_.lights = graph.light_nodes;
    if (document_.model().scenes.empty()) return;
    const int shown = shown_scene(document_.model(), options_.scene);
    scene.environment_rays = read_visibility(element(document_.model().scenes, shown).extensions).rays;
    if ((scene.environment_rays & (kCameraRays | kBounceRays)) == 0)
      warnings_.add(
          fmt::format("scenes[{}].extensions.{}: no ray sees the environment", shown, kVisibilityExtension));
  }

  /// Once the list of instances is complete.
  void take_links(Scene& scene) const {
    if (document_.model().scenes.empty()) return;
    Warnings warnings;
    read_light_links(document_, shown_scene(document_.model(), options_.scene), nodes_, scene, warnings);
    for (std::string& warning : warnings.take()) scene.warnings.push_back(std::move(warning));
  }

  /// By those of another time. Their links are the same at all times.
  static void replace_lights(const Graph& graph, Scene& scene) {
    const std::vector<PunctualLight> before = std::exchange(scene.lights, graph.lights);
    for (std::size_t i = 0; i < std::min(before.size(), scene.lights.size()); ++i)
      scene.lights[i].link = before[i].link;
  }

  void adjust(Scene& scene) const {
    scene.dark_lights.clear();
    adjust_lights(scene, options_.lights);
    give_profiles(scene, options_.profiles);
  }

  void check_bounds(const Scene& scene, const Box& bounds) const {
    const std::string wrong = wrong_bounds(scene, bounds);
    if (!wrong.empty()) document_.fail("the world", wrong);
  }

  LoadOptions options_;
  std::string path_;
  Warnings warnings_;
  Document document_;
  Appearance appearance_;
  Motion motion_;
  SourceNodes nodes_;
  std::optional<Parts> parts_;
  std::optional<Animator> animator_;
  std::vector<int> culled_copies_;
};

}  // namespace gltf

/// Runs all work in an arena of its own.
struct SceneFile::Implementation {
  Implementation(const std::filesystem::path& path, const LoadOptions& options) : threads(options.threads) {
    if (options.time) check_time(*options.time);
    if (!(options.shutter >= 0.0) || !std::isfinite(options.shutter))
      throw BadOption(
          {"shutter", fmt::format("{}", options.shutter), "", "a finite number of seconds, not below 0"});
    if (threads <= 0) threads = available_threads();
    require_threads(threads);
    run([&] { loader.emplace(path, options); });
  }

  static void check_time(double time) {
    if (!std::isfinite(time))
      throw BadOption({"time", fmt::format("{}", time), "", "a finite number of seconds"});
  }

  template <typename Work>
  void run(const Work& work) const {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute(work);
  }

  int threads;
  std::optional<gltf::Loader> loader;
};

SceneFile::SceneFile(const std::filesystem::path& path, const LoadOptions& options)
    : implementation_(std::make_unique<Implementation>(path, options)) {}
SceneFile::~SceneFile() = default;

Scene SceneFile::read() {
  Scene scene;
  implementation_->run([&] { scene = implementation_->loader->read(); });
  return scene;
}

void SceneFile::finish(Scene& scene) {
  implementation_->run([&] { implementation_->loader->finish(scene); });
}

Scene SceneFile::load() {
  Scene scene = read();
  finish(scene);
  return scene;
}

void SceneFile::show(Scene& scene, double seconds) {
  Implementation::check_time(seconds);
  implementation_->run([&] { implementation_->loader->show(scene, seconds); });
}

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  return SceneFile(path, options).load();
}

}  // namespace gatelight::scene
