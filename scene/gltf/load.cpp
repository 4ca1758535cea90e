#include "scene/gltf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <span>
#include <utility>

#include "base/nearest_word.h"
#include "base/platform/threads.h"
#include "scene/bake.h"
#include "scene/doubled_lamps.h"
#include "scene/gltf/accessors.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/document.h"
#include "scene/gltf/image_light.h"
#include "scene/gltf/images.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/model.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/primitives.h"
#include "scene/gltf/triangles.h"
#include "scene/texture_slots.h"

namespace gatelight::scene {
namespace gltf {
namespace {

/// Larger coordinates are refused: the square of a triangle's area would overflow single precision.
constexpr float kLargestCoordinate = 1e9f;

/// Size of a position, normal, tangent, two texture coordinates and a colour.
constexpr std::size_t kVertexBytes = (3 + 3 + 4 + 2 + 2 + 4) * sizeof(float);

/// Renumbers the objects that are used, in the order of their first use.
class Numbering {
 public:
  int number_of(int original) {
    const auto [entry, is_new] = numbers_.try_emplace(original, static_cast<int>(order_.size()));
    if (is_new) order_.push_back(original);
    return entry->second;
  }
  const std::vector<int>& order() const { return order_; }

 private:
  std::map<int, int> numbers_;
  std::vector<int> order_;
};

class Loader {
 public:
  Loader(const std::filesystem::path& path, const LoadOptions& options)
      : options_(options), document_(path, options, warnings_) {
    scene_.path = path.string();
  }

  Scene load() {
    scene_.animations = document_.animations();
    read_variants();
    if (options_.time) Animator(document_, warnings_).apply(*options_.time, warnings_);
    Graph graph = flatten_nodes(document_, options_, warnings_);
    scene_.lights = std::move(graph.lights);
    scene_.cameras = std::move(graph.cameras);
    load_materials(graph);
    claim_memory(graph);
    load_meshes(graph);
    choose_origin(graph);
    place(graph.placements);
    load_images();
    if (!document_.model().scenes.empty()) {
      const int shown = shown_scene(document_.model(), options_.scene);
      scene_.image_light = load_image_light(document_, shown, options_.missing_is_error, warnings_);
    }
    if (options_.bake_transforms) bake_transforms(scene_);
    separate_doubled_lamps(scene_);
    scene_.bounds = compute_bounds(scene_);
    check_bounds();
    adjust_lights(scene_, options_.lights);
    give_profiles(scene_, options_.profiles);
    scene_.warnings = warnings_.take();
    return std::move(scene_);
  }

 private:
  /// A primitive in a pose.
  struct Part {
    int pose;
    int mesh;
    int primitive;
    int material;  ///< index into scene_.materials
  };

  void read_variants() {
    if (const tinygltf::Value* extension =
            find_extension(document_.model().extensions, "KHR_materials_variants")) {
      for (const tinygltf::Value& variant : array_of(*extension, "variants"))
        scene_.variants.push_back(text_or(variant, "name", ""));
    }
    if (options_.variant.empty()) return;
    const auto found = std::find(scene_.variants.begin(), scene_.variants.end(), options_.variant);
    if (found == scene_.variants.end()) {
      document_.fail(
          "KHR_materials_variants",
          fmt::format("variant '{}' is not there, expected {}{}", options_.variant,
                      scene_.variants.empty() ? "none: the file has no variants"
                                              : fmt::format("one of: {}", fmt::join(scene_.variants, ", ")),
                      did_you_mean(options_.variant, scene_.variants)));
    }
    variant_ = static_cast<int>(found - scene_.variants.begin());
  }

  int material_of(const tinygltf::Primitive& primitive) const {
    const tinygltf::Value* extension = find_extension(primitive.extensions, "KHR_materials_variants");
    if (variant_ >= 0 && extension) {
      for (const tinygltf::Value& mapping : array_of(*extension, "mappings")) {
        for (const tinygltf::Value& variant : array_of(mapping, "variants")) {
          if (variant.GetNumberAsInt() == variant_) return integer_or(mapping, "material", -1);
        }
      }
    }
    return primitive.material;
  }

  /// The file's first image with the same URI and buffer view, so that equal images are decoded once.
  int first_alike(int image) {
    const tinygltf::Image& source = element(document_.model().images, image);
    if (source.uri.empty() && source.bufferView < 0) return image;
    return alike_.try_emplace({source.uri, source.bufferView}, image).first->second;
  }

  /// Loads the materials and textures, and numbers the images, of the placed meshes only.
  void load_materials(const Graph& graph) {
    Numbering materials;
    Numbering textures;
    first_part_.assign(graph.poses.size(), -1);
    for (const Placement& placement : graph.placements) {
      int& first = first_part_[static_cast<std::size_t>(placement.pose)];
      if (first >= 0) continue;
      first = static_cast<int>(parts_.size());
      const int mesh = element(graph.poses, placement.pose).mesh;
      const auto& primitives = element(document_.model().meshes, mesh).primitives;
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        parts_.push_back(
            {placement.pose, mesh, static_cast<int>(i), materials.number_of(material_of(primitives[i]))});
      }
    }
    for (const int original : materials.order()) {
      Material material = convert_material(document_, original, warnings_);
      for_each_slot(material, [&](TextureSlot& slot, bool) {
        if (slot) slot.texture = textures.number_of(slot.texture);
      });
      const bool one_sided = !material.double_sided && !material.transmits();
      material.culled = one_sided && options_.back_faces == BackFaces::cull;
      material.double_sided |= material.emits() && options_.back_faces == BackFaces::light;
      scene_.materials.push_back(std::move(material));
    }
    for (const int original : textures.order()) {
      Texture texture = convert_texture(document_, original);
      texture.image = images_.number_of(first_alike(texture.image));
      scene_.textures.push_back(texture);
    }
  }

  /// Memory of a primitive according to its accessors; 0 for Draco, whose size is only in the compressed
  /// data.
  std::size_t mesh_bytes(const Part& part) const {
    const tinygltf::Primitive& primitive =
        element(element(document_.model().meshes, part.mesh).primitives, part.primitive);
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end() || primitive.mode < TINYGLTF_MODE_TRIANGLES) return 0;
    if (find_extension(primitive.extensions, "KHR_draco_mesh_compression")) return 0;
    const auto count_of = [&](int accessor) { return element(document_.model().accessors, accessor).count; };
    const std::size_t vertices = count_of(positions->second);
    const std::size_t indices = primitive.indices >= 0 ? count_of(primitive.indices) : vertices;
    const std::size_t triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? indices / 3 : indices;
    return triangles * sizeof(std::array<std::uint32_t, 3>) +
           std::min(vertices, 3 * triangles) * kVertexBytes;
  }

  void claim_memory(const Graph& graph) const {
    for (const Part& part : parts_) {
      document_.claim(mesh_bytes(part), fmt::format("meshes[{}].primitives[{}]", part.mesh, part.primitive));
    }
    for (const Placement& placement : graph.placements) {
      const bool copied = options_.bake_transforms && is_flat(placement.transform);
      std::size_t bytes = 0;
      for_each_part(placement, [&](std::size_t i) {
        bytes += sizeof(Instance) + placement.name.size() + (copied ? mesh_bytes(parts_[i]) : 0);
      });
      document_.claim(bytes, fmt::format("meshes[{}]", element(graph.poses, placement.pose).mesh));
    }
  }

  /// Calls load(i, warnings) for every i below count, in parallel. Rethrows the exception of the lowest
  /// index, so that the message does not depend on the schedule.
  template <typename Load>
  void load_each(std::size_t count, const Load& load) {
    std::vector<Warnings> warnings(count);
    std::vector<std::exception_ptr> errors(count);
    std::atomic<std::size_t> first_error{count};
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (i > first_error) return;
      try {
        load(i, warnings[i]);
      } catch (...) {
        errors[i] = std::current_exception();
        std::size_t first = first_error;
        while (i < first && !first_error.compare_exchange_weak(first, i)) {
        }
      }
    });
    if (first_error < count) std::rethrow_exception(errors[first_error]);
    for (const Warnings& w : warnings) warnings_.merge(w);
  }

  void load_meshes(const Graph& graph) {
    scene_.meshes.resize(parts_.size());
    load_each(parts_.size(), [&](std::size_t i, Warnings& warnings) {
      const Part& part = parts_[i];
      const Material& material = scene_.materials[static_cast<std::size_t>(part.material)];
      const Pose& pose = element(graph.poses, part.pose);
      std::span<const JointMatrix> joints;
      if (pose.skin >= 0) joints = element(graph.joints, pose.skin);
      scene_.meshes[i] = load_primitive(document_, pose, part.primitive, joints, material, warnings);
      scene_.meshes[i].material = part.material;
    });
  }

  /// Which images are normal maps in all their uses.
  std::vector<char> normal_maps() const {
    std::vector<char> result(images_.order().size(), 1);
    for (const Material& material : scene_.materials) {
      for_each_slot(material, [&](const TextureSlot& slot, bool) {
        if (!slot || is_normal_map(material, slot)) return;
        const int image = scene_.textures[static_cast<std::size_t>(slot.texture)].image;
        if (image >= 0) result[static_cast<std::size_t>(image)] = 0;
      });
    }
    return result;
  }

  void load_images() {
    scene_.images.resize(images_.order().size());
    const std::vector<char> normal = normal_maps();
    load_each(scene_.images.size(), [&](std::size_t i, Warnings& warnings) {
      const ImageOptions options{.missing_is_error = options_.missing_is_error, .normal_map = normal[i] != 0};
      scene_.images[i] = load_image(document_, images_.order()[i], options, warnings);
    });
  }

  /// Sets Scene::origin to the scene's centre if that is far away, and moves cameras and lights.
  void choose_origin(const Graph& graph) {
    std::vector<Box> boxes(parts_.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (const Vec3& p : scene_.meshes[i].positions) boxes[i].extend(p);
    }
    Eigen::AlignedBox3d bounds;
    for (const Placement& placement : graph.placements) {
      for_each_part(placement, [&](std::size_t i) {
        if (boxes[i].isEmpty()) return;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3 p = boxes[i].corner(static_cast<Box::CornerType>(corner));
          bounds.extend(placement.transform.linear().cast<double>() * p.cast<double>() +
                        placement.translation);
        }
      });
    }
    if (bounds.isEmpty()) return;
    const double radius = 0.5 * bounds.diagonal().norm();
    if (!(bounds.center().norm() > kFarFromOrigin * radius) || !(radius > 0.0)) return;
    // The centre is rounded so that single precision holds it exactly.
    const Eigen::Vector3d center = bounds.center();
    const double step = std::exp2(std::ceil(std::log2(center.cwiseAbs().maxCoeff())) - 23.0);
    const Eigen::Vector3d origin = (center / step).array().round() * step;
    scene_.origin = origin.cast<float>();
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i)
      scene_.cameras[i].transform.translation() = from_origin(graph.camera_positions[i]);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      scene_.lights[i].position = from_origin(graph.light_positions[i]);
  }

  Vec3 from_origin(const Eigen::Vector3d& position) const {
    const Eigen::Vector3d origin = scene_.origin.cast<double>();
    const Eigen::Vector3d from = position - origin;
    return from.cast<float>();
  }

  template <typename Function>
  void for_each_part(const Placement& placement, Function function) const {
    const auto first = static_cast<std::size_t>(first_part_[static_cast<std::size_t>(placement.pose)]);
    for (std::size_t i = first; i < parts_.size() && parts_[i].pose == placement.pose; ++i) function(i);
  }

  void place(const std::vector<Placement>& placements) {
    for (const Placement& placement : placements) {
      for_each_part(placement, [&](std::size_t i) {
        if (scene_.meshes[i].triangles.empty()) return;
        Instance instance;
        instance.name = placement.name;
        instance.mesh = static_cast<int>(i);
        instance.transform = placement.transform;
        instance.transform.translation() = from_origin(placement.translation);
        // Computed in double: the product of three small scales would underflow in single precision.
        instance.mirrors = placement.transform.linear().cast<double>().determinant() < 0.0;
        instance.placement = static_cast<int>(&placement - placements.data());
        instance.dielectric_priority = placement.dielectric_priority;
        scene_.instances.push_back(std::move(instance));
      });
    }
    drop_unused_meshes(scene_);
  }

  void check_bounds() const {
    if (scene_.bounds.isEmpty() && scene_.instances.empty()) return;
    const Vec3 furthest = (scene_.origin + scene_.bounds.min())
                              .cwiseAbs()
                              .cwiseMax((scene_.origin + scene_.bounds.max()).cwiseAbs());
    if (furthest.allFinite() && furthest.maxCoeff() <= kLargestCoordinate) return;
    document_.fail("the world", fmt::format("a vertex at ({}, {}, {}), expected at most {:g} from the origin",
                                            furthest.x(), furthest.y(), furthest.z(), kLargestCoordinate));
  }

  LoadOptions options_;
  Warnings warnings_;
  Document document_;
  Scene scene_;
  int variant_ = -1;
  std::vector<Part> parts_;
  std::vector<int> first_part_;  ///< by the pose; its parts are consecutive
  Numbering images_;
  std::map<std::pair<std::string, int>, int> alike_;  ///< by URI and buffer view
};

}  // namespace
}  // namespace gltf

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  if (options.time && !std::isfinite(*options.time))
    throw BadOption(fmt::format("`time` {}: expected a finite number of seconds", *options.time));
  const int threads = options.threads > 0 ? options.threads : available_threads();
  require_threads(threads);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  return tbb::task_arena(threads).execute([&] { return gltf::Loader(path, options).load(); });
}

}  // namespace gatelight::scene
