#include "scene/coincident_emitters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/bake.h"

namespace gatelight::scene {
namespace {

using Corners = std::array<std::array<float, 3>, 3>;

/// The place of a triangle: its corners in ascending order, and the mesh in whose space they are, or -1 for
/// the world. Of triangles that different rays see, none can stand for another.
struct Place {
  Corners corners;
  int space;
  Visibility visibility;

  bool operator==(const Place&) const = default;
};

std::size_t hash_of(std::size_t hash, const std::array<float, 3>& corner) {
  for (const float x : corner) hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

struct Hash {
  std::size_t operator()(const Place& place) const {
    std::size_t hash = static_cast<std::size_t>(place.space);
    for (const auto& corner : place.corners) hash = hash_of(hash, corner);
    return hash;
  }
};

/// Says quickly of most corners that no lamp has them. Most triangles of a scene are far from its lamps.
class CornerFilter {
 public:
  void add(const std::array<float, 3>& corner) { bits_[hash_of(0, corner) % kBits] = true; }
  bool may_have(const std::array<float, 3>& corner) const { return bits_[hash_of(0, corner) % kBits]; }

 private:
  static constexpr std::size_t kBits = std::size_t{1} << 20;
  std::vector<bool> bits_ = std::vector<bool>(kBits);
};

struct Face {
  int mesh;
  std::uint32_t triangle;
  bool turned;  ///< its front is on the second side of the place
};

/// What becomes of a triangle.
enum class Fate : std::uint8_t { stays, culled, removed };

class Separator {
 public:
  explicit Separator(Scene& scene) : scene_(scene), instance_of_(scene.meshes.size(), kNone) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      int& instance = instance_of_[static_cast<std::size_t>(scene.instances[i].mesh)];
      instance = instance == kNone && !scene.instances[i].moves ? static_cast<int>(i) : kShared;
    }
  }

  std::vector<int> separate() {
    find_emitters();
    if (places_.empty()) return {};
    find_others();
    for (const auto& [place, faces] : places_) {
      if (faces.size() > 1) decide(faces);
    }
    const std::size_t count = scene_.meshes.size();
    for (std::size_t m = 0; m < count; ++m) {
      if (!fates_[m].empty()) apply(m);
    }
    if (empty_) {
      std::erase_if(scene_.instances, [&](const Instance& i) { return scene_.mesh_of(i).triangles.empty(); });
      drop_unused_meshes(scene_);
    }
    return std::move(copies_);
  }

 private:
  static constexpr int kNone = -1;
  static constexpr int kShared = -2;

  const Material& material_of(int mesh) const {
    const int material = scene_.meshes[static_cast<std::size_t>(mesh)].material;
    return scene_.materials[static_cast<std::size_t>(material)];
  }

  bool is_lamp(int mesh) const {
    const Material& m = material_of(mesh);
    return m.emits() && !m.unlit && !m.transmits() && m.alpha_mode == AlphaMode::opaque;
  }

  /// Calls use(place, face) for each triangle of a mesh whose corners pass(corner).
  template <typename Pass, typename Use>
  void for_each_face(int m, const Pass& pass, const Use& use) const {
    const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(m)];
    const int number = instance_of_[static_cast<std::size_t>(m)];
    if (number == kNone || mesh.deforming >= 0) return;
    const Instance* const instance =
        number == kShared ? nullptr : &scene_.instances[static_cast<std::size_t>(number)];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Place place{{}, instance ? -1 : m, instance ? instance->visibility : Visibility()};
      bool passes = true;
      for (std::size_t c = 0; c < 3 && passes; ++c) {
        Vec3 p = mesh.positions[mesh.triangles[t][c]];
        if (instance && !instance->baked) p = instance->transform * p;
        p.array() += 0.0f;  // no negative zeros
        place.corners[c] = {p.x(), p.y(), p.z()};
        passes = pass(place.corners[c]);
      }
      if (!passes) continue;
      bool turned = instance && !instance->baked && instance->swaps_handedness;
      auto& [a, b, c] = place.corners;
      const auto order = [&](auto& first, auto& second) {
        if (!(second < first)) return;
        std::swap(first, second);
        turned = !turned;
      };
      order(a, b);
      order(b, c);
      order(a, b);
      if (a != b && b != c) use(place, Face{m, t, turned});
    }
  }

  void find_emitters() {
    for (int m = 0; m < static_cast<int>(scene_.meshes.size()); ++m) {
      if (!is_lamp(m)) continue;
      for_each_face(
          m, [](const auto&) { return true; },
          [&](const Place& place, Face) {
            places_.try_emplace(place);
            for (const auto& corner : place.corners) corners_.add(corner);
          });
    }
  }

  void find_others() {
    std::vector<std::vector<std::pair<Place, Face>>> near_lamps(scene_.meshes.size());
    tbb::parallel_for(std::size_t{0}, near_lamps.size(), [&](std::size_t m) {
      for_each_face(
          static_cast<int>(m), [&](const auto& corner) { return corners_.may_have(corner); },
          [&](const Place& place, Face face) { near_lamps[m].emplace_back(place, face); });
    });
    for (const auto& faces : near_lamps) {
      for (const auto& [place, face] : faces) {
        const auto found = places_.find(place);
        if (found != places_.end()) found->second.push_back(face);
      }
    }
    fates_.resize(scene_.meshes.size());
  }

  /// The face that is seen from a side of a place.
  const Face& seen(const std::vector<Face>& faces, bool second_side) const {
    const auto rank = [&](const Face& face) {
      const bool both = material_of(face.mesh).double_sided;
      const bool front = face.turned == second_side;
      if (is_lamp(face.mesh) && (front || both)) return 3;
      return front ? 2 : both ? 1 : 0;
    };
    return *std::max_element(faces.begin(), faces.end(),
                             [&](const Face& a, const Face& b) { return rank(a) < rank(b); });
  }

  void decide(const std::vector<Face>& faces) {
    const Face& first = seen(faces, false);
    const Face& second = seen(faces, true);
    const bool apart = !first.turned && second.turned;
    for (const Face& face : faces) {
      const bool stays = &face == &first || &face == &second;
      // One of two that are both the front of one side cannot be seen from the other only: the lamp stays.
      const bool kept = &first == &second || apart ? stays : stays && is_lamp(face.mesh);
      set(face, !kept ? Fate::removed : apart ? Fate::culled : Fate::stays);
    }
  }

  void set(const Face& face, Fate fate) {
    std::vector<Fate>& fates = fates_[static_cast<std::size_t>(face.mesh)];
    fates.resize(scene_.meshes[static_cast<std::size_t>(face.mesh)].triangles.size(), Fate::stays);
    fates[face.triangle] = fate;
  }

  void apply(std::size_t m) {
    const std::vector<Fate>& fates = fates_[m];
    const auto keep = [&](Mesh& mesh, Fate fate) {
      std::size_t kept = 0;
      for (std::size_t t = 0; t < fates.size(); ++t) {
        if (fates[t] == fate) mesh.triangles[kept++] = mesh.triangles[t];
      }
      mesh.triangles.resize(kept);
    };
    const auto has = [&](Fate fate) { return std::find(fates.begin(), fates.end(), fate) != fates.end(); };
    Mesh culled;
    if (has(Fate::culled)) {
      culled = scene_.meshes[m];
      keep(culled, Fate::culled);
      culled.material = culled_material(culled.material);
    }
    keep(scene_.meshes[m], Fate::stays);
    if (scene_.meshes[m].triangles.empty()) {
      empty_ |= culled.triangles.empty();
      scene_.meshes[m] = std::move(culled);
    } else if (!culled.triangles.empty()) {
      const std::size_t count = scene_.instances.size();
      for (std::size_t i = 0; i < count; ++i) {
        if (scene_.instances[i].mesh != static_cast<int>(m)) continue;
        scene_.instances.push_back(scene_.instances[i]);
        scene_.instances.back().mesh = static_cast<int>(scene_.meshes.size());
      }
      scene_.meshes.push_back(std::move(culled));
    }
  }

  int culled_material(int material) {
    const auto [entry, is_new] = culled_.try_emplace(material, static_cast<int>(scene_.materials.size()));
    if (is_new) {
      add_culled_copy(scene_, material);
      copies_.push_back(material);
    }
    return entry->second;
  }

  Scene& scene_;
  std::vector<int> instance_of_;  ///< by mesh
  std::unordered_map<Place, std::vector<Face>, Hash> places_;
  CornerFilter corners_;
  std::vector<std::vector<Fate>> fates_;  ///< by mesh and triangle; empty where all stay
  std::unordered_map<int, int> culled_;   ///< by material
  std::vector<int> copies_;
  bool empty_ = false;
};

}  // namespace

std::vector<int> separate_coincident_emitters(Scene& scene) {
  return Separator(scene).separate();
}

void add_culled_copy(Scene& scene, int material) {
  Material copy = scene.materials[static_cast<std::size_t>(material)];
  copy.culled = true;
  copy.double_sided = false;
  scene.materials.push_back(std::move(copy));
}

}  // namespace gatelight::scene
