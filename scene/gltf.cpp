#include "scene/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene/bake.h"
#include "scene/bounds.h"
#include "scene/gltf_accessors.h"
#include "scene/gltf_document.h"
#include "scene/gltf_extensions.h"
#include "scene/gltf_images.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_primitives.h"
#include "scene/parallel.h"

namespace gatelight::scene {
namespace gltf {
namespace {

/// Coordinates beyond this are refused: the square of a triangle's area would leave single precision.
constexpr float kLargestCoordinate = 1e9f;

/// Gives numbers to the things that are used, in the order of their first use.
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
      : options_(options), document_(path, warnings_) {
    scene_.path = path.string();
  }

  Scene load() {
    check_accessors(document_);
    read_variants();
    Graph graph = flatten_nodes(document_, options_.scene, warnings_);
    scene_.lights = std::move(graph.lights);
    scene_.cameras = std::move(graph.cameras);
    load_materials(graph.placements);
    load_meshes();
    place(graph.placements);
    load_images();
    if (options_.bake_transforms) bake_transforms(scene_);
    scene_.bounds = compute_bounds(scene_);
    check_bounds();
    scene_.warnings = warnings_.take();
    return std::move(scene_);
  }

 private:
  struct Part {
    int mesh;
    int primitive;
    int material;  ///< number in scene_.materials
  };

  void read_variants() {
    const tinygltf::Value* extension = find_extension(document_.model().extensions, "KHR_materials_variants");
    if (extension) {
      const tinygltf::Value& list = extension->Get("variants");
      for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
        scene_.variants.push_back(text_or(list.Get(static_cast<int>(i)), "name", ""));
      }
    }
    if (options_.variant.empty()) return;
    const auto found = std::find(scene_.variants.begin(), scene_.variants.end(), options_.variant);
    if (found == scene_.variants.end()) {
      document_.fail(
          "KHR_materials_variants",
          fmt::format("variant '{}' is not there, expected {}", options_.variant,
                      scene_.variants.empty() ? "none: the file has no variants"
                                              : fmt::format("one of: {}", fmt::join(scene_.variants, ", "))));
    }
    variant_ = static_cast<int>(found - scene_.variants.begin());
  }

  int material_of(const tinygltf::Primitive& primitive) const {
    const tinygltf::Value* extension = find_extension(primitive.extensions, "KHR_materials_variants");
    if (variant_ < 0 || !extension) return primitive.material;
    const tinygltf::Value& mappings = extension->Get("mappings");
    for (std::size_t i = 0; i < mappings.ArrayLen(); ++i) {
      const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i));
      const tinygltf::Value& variants = mapping.Get("variants");
      for (std::size_t k = 0; k < variants.ArrayLen(); ++k) {
        if (variants.Get(static_cast<int>(k)).GetNumberAsInt() == variant_) {
          return integer_or(mapping, "material", primitive.material);
        }
      }
    }
    return primitive.material;
  }

  /// Materials, textures and image numbers of what is placed in the scene, and nothing else.
  void load_materials(const std::vector<Placement>& placements) {
    Numbering materials;
    Numbering textures;
    first_part_.assign(document_.model().meshes.size(), -1);
    for (const Placement& placement : placements) {
      int& first = first_part_[static_cast<std::size_t>(placement.mesh)];
      if (first >= 0) continue;
      first = static_cast<int>(parts_.size());
      const auto& primitives = document_.model().meshes[static_cast<std::size_t>(placement.mesh)].primitives;
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        parts_.push_back(
            {placement.mesh, static_cast<int>(i), materials.number_of(material_of(primitives[i]))});
      }
    }
    for (const int original : materials.order()) {
      Material material = convert_material(document_, original, warnings_);
      for_each_slot(material, [&](TextureSlot& slot) {
        if (slot) slot.texture = textures.number_of(slot.texture);
      });
      scene_.materials.push_back(std::move(material));
    }
    for (const int original : textures.order()) {
      Texture texture = convert_texture(document_, original);
      texture.image = images_.number_of(texture.image);
      scene_.textures.push_back(texture);
    }
  }

  void load_meshes() {
    scene_.meshes.resize(parts_.size());
    std::vector<Warnings> warnings(parts_.size());
    parallel_for(parts_.size(), [&](std::size_t i) {
      const Part& part = parts_[i];
      const Material& material = scene_.materials[static_cast<std::size_t>(part.material)];
      scene_.meshes[i] = load_primitive(document_, part.mesh, part.primitive, material, warnings[i]);
      scene_.meshes[i].material = part.material;
    });
    for (const Warnings& w : warnings) warnings_.merge(w);
  }

  void load_images() {
    const std::vector<int>& order = images_.order();
    scene_.images.resize(order.size());
    std::vector<Warnings> warnings(order.size());
    parallel_for(order.size(), [&](std::size_t i) {
      scene_.images[i] = load_image(document_, order[i], options_.missing_is_error, warnings[i]);
    });
    for (const Warnings& w : warnings) warnings_.merge(w);
  }

  void place(const std::vector<Placement>& placements) {
    for (const Placement& placement : placements) {
      const std::size_t first =
          static_cast<std::size_t>(first_part_[static_cast<std::size_t>(placement.mesh)]);
      for (std::size_t i = first; i < parts_.size() && parts_[i].mesh == placement.mesh; ++i) {
        if (scene_.meshes[i].triangles.empty()) continue;
        Instance instance;
        instance.name = placement.name;
        instance.mesh = static_cast<int>(i);
        instance.transform = placement.transform;
        // In double: the product of three small scales leaves single precision.
        instance.mirrors = placement.transform.linear().cast<double>().determinant() < 0.0;
        scene_.instances.push_back(std::move(instance));
      }
    }
    drop_unused_meshes(scene_);
  }

  void check_bounds() const {
    if (scene_.bounds.isEmpty() && scene_.instances.empty()) return;
    const Vec3 furthest = scene_.bounds.min().cwiseAbs().cwiseMax(scene_.bounds.max().cwiseAbs());
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
  std::vector<int> first_part_;  ///< by the file's mesh; its parts follow each other
  Numbering images_;
};

}  // namespace
}  // namespace gltf

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  return gltf::Loader(path, options).load();
}

}  // namespace gatelight::scene
