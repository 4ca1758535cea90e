#pragma once
// Bodies of glass or liquid that overlap, or lie inside one another, and the choice of the one that fills the
// shared space: Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images".

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// No volume.
inline constexpr std::uint32_t kNoVolume = 0xffffffffu;

/// A volume is enclosed by the surfaces with an inside (Material::has_volume) of one material of a placed
/// mesh, by themselves or with other surfaces of the mesh. It has no holes, nor alpha, and its front faces
/// look outwards. Only volumes whose bounding boxes touch another's, up to rounding, are listed: paths need
/// not track the others.
struct NestedVolumes {
  /// By instance: the number of the volume that it bounds, or kNoVolume. Empty if no volumes overlap. Among
  /// the volumes around a point, the one with the smallest number fills it. Numbers follow the larger
  /// priority, then the smaller volume, then the earlier placement. So a volume wholly inside another is
  /// visible without a priority.
  std::vector<std::uint32_t> of_instance;
  /// By number: an instance that bounds the volume. Its material is that of the inside.
  std::vector<std::uint32_t> instances;

  bool empty() const { return instances.empty(); }
};

/// `all`: lists volumes that touch no other, too.
NestedVolumes find_nested_volumes(const Scene& scene, bool all = false);

/// The volume that the triangles of an instance enclose, in cubic metres; 0 where they have a hole, or their
/// front faces look inwards.
double enclosed_volume(const Scene& scene, std::uint32_t instance);

/// A body of glass or liquid that encloses a volume (NestedVolumes), whether or not it touches another one.
struct EnclosedBody {
  std::vector<std::uint32_t> instances;
  std::vector<std::uint32_t> closing;  ///< opaque surfaces that close it
};

/// The bodies whose bounding boxes touch `places`, at any time of an open shutter.
std::vector<EnclosedBody> find_bodies_at(const Scene& scene, const Box& places);

/// The materials that scatter in a body with a hole, which light might never leave, in order.
std::vector<int> open_scatterers(const Scene& scene);

}  // namespace gatelight::scene
