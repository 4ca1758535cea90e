#pragma once
// The medium around a path, where bodies of glass and liquid overlap or lie inside one another
// (scene/nested_volumes.h).

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/medium/scattering_medium.h"
#include "renderer/surface/ray.h"
#include "scene/nested_volumes.h"

namespace gatelight::renderer {

/// The volumes around a point, by their numbers: the smallest one is the strongest and fills the space. Of
/// more than kMax the weakest are forgotten; a path that leaves one of them later was in it nevertheless.
class MediumStack {
 public:
  static constexpr int kMax = 8;

  std::uint32_t strongest() const { return count_ > 0 ? volumes_[0] : scene::kNoVolume; }
  /// The strongest of the others.
  std::uint32_t strongest_but(std::uint32_t volume) const {
    const std::uint8_t first = strongest() == volume ? 1 : 0;
    return first < count_ ? volumes_[first] : scene::kNoVolume;
  }
  void enter(std::uint32_t volume);
  void leave(std::uint32_t volume);
  void cross(std::uint32_t volume, bool enters) { enters ? enter(volume) : leave(volume); }

 private:
  std::array<std::uint32_t, kMax> volumes_{};  ///< the first `count_`
  std::uint8_t count_ = 0;
};

/// What a path starts in.
struct StartMedium {
  MediumStack volumes;
  std::uint32_t body = kNoInstance;  ///< a surface of a body around the start that is none of the volumes
};

/// Extinction per metre inside a material: absorption, and scattering where there is any. Of light of one
/// direction c = exp(-extinction d) is left after the distance d. A black channel loses all within a
/// thousandth of the distance.
Color extinction_of(const scene::Material& m);

struct Medium {
  float ior = 1.0f;
  float dispersion = 0.0f;
  const ScatteringMedium* inside = nullptr;  ///< null: clear
  std::uint32_t instance = kNoInstance;      ///< that bounds it; none of air
};

class Media {
 public:
  Media() = default;
  /// `nested`: SceneRequirements::nested_volumes. Otherwise none is searched, unless there is fog around
  /// them. `unrefracted_glass`: GlassShadows::straight.
  Media(const scene::Scene& scene, bool nested, bool unrefracted_glass,
        const std::optional<ScatteringMedium>& fog = {});
  Media(const Media&) = delete;
  Media& operator=(const Media&) = delete;

  /// About bodies that should scatter and have holes; empty where there are none.
  const std::string& warning() const { return warning_; }
  bool empty() const { return media_.empty(); }
  /// The volume that the surfaces of an instance bound, or kNoVolume.
  std::uint32_t volume_of(std::uint32_t instance) const {
    return empty() ? scene::kNoVolume : of_instance_[instance];
  }
  /// Whether the boundary of `volume`, or of glass that is no volume, exists for a path in the volumes
  /// `around` on either side of it. Otherwise a stronger volume fills the space on both sides.
  bool is_there(std::uint32_t volume, const MediumStack& around) const {
    return volume == scene::kNoVolume || volume < around.strongest_but(volume);
  }
  /// The strongest volume on the other side of such a boundary.
  const Medium& beyond(std::uint32_t volume, const MediumStack& around) const {
    return of(around.strongest_but(volume));
  }
  /// The medium of a volume; air outside of all volumes.
  const Medium& of(std::uint32_t volume) const { return volume == scene::kNoVolume ? air_ : media_[volume]; }
  /// What a material encloses; null where that is clear.
  const ScatteringMedium* inside(int material) const {
    const ScatteringMedium& medium = insides_[static_cast<std::size_t>(material)];
    return (medium.extinction > 0.0f).any() ? &medium : nullptr;
  }

 private:
  std::vector<ScatteringMedium> insides_;  ///< by material
  std::optional<ScatteringMedium> fog_;
  std::string warning_;
  std::vector<std::uint32_t> of_instance_;
  std::vector<Medium> media_;  ///< by volume
  Medium air_;
};

/// What a path travels in, and whose it is.
struct InsideOf {
  const ScatteringMedium* medium = nullptr;  ///< null: clear
  std::uint32_t instance = kNoInstance;      ///< of the body; none of air
};

/// Crosses a surface with an inside and returns what is behind it: the inside of the strongest volume there,
/// or the surface's own, which `material` encloses, where it is none of the volumes and the ray enters it.
inline InsideOf cross(const Media& media, MediumStack& interior, std::uint32_t volume, bool enters,
                      std::uint32_t instance, int material) {
  if (volume == scene::kNoVolume && enters) return {media.inside(material), instance};
  if (volume != scene::kNoVolume) interior.cross(volume, enters);
  const Medium& strongest = media.of(interior.strongest());
  return {strongest.inside, strongest.instance};
}

/// The share of a surface that is glass.
inline float glass_share(const SurfaceMaterial& m) {
  return (1.0f - m.metallic) * m.transmission;
}

/// Replaces the material of a boundary that is not there, by the choice of `u` in [0, 1): with the
/// probability glass_share() by a clear pane, otherwise by the part of the surface that is not glass. Returns
/// true for a pane.
bool make_index_matched(SurfaceMaterial& material, float u);

}  // namespace gatelight::renderer
