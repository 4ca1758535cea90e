#pragma once
// Bodies of glass or liquid that overlap, or lie inside one another, and which of them fills the space that
// several claim: Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images".

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// No volume.
inline constexpr std::uint32_t kNoVolume = 0xffffffffu;

/// A volume is what the surfaces with an inside (Material::has_volume) of one material of a placed mesh
/// close, alone or with other surfaces of the mesh. It has no holes, nor alpha, and its front faces look
/// outwards. Only volumes whose bounding boxes touch another's are listed: nobody has to know where a ray is
/// in all others.
struct NestedVolumes {
  /// By instance: the number of the volume that it bounds, or kNoVolume. Empty if no volumes overlap. Of the
  /// volumes around a point that with the smallest number fills it. Numbers follow the larger priority, then
  /// the smaller volume, then the earlier placement. So what lies wholly inside something else needs no
  /// priority to be seen.
  std::vector<std::uint32_t> of_instance;
  /// By number: an instance that bounds the volume. Its material is that of the inside.
  std::vector<std::uint32_t> instances;

  bool empty() const { return instances.empty(); }
};

NestedVolumes find_nested_volumes(const Scene& scene);

}  // namespace gatelight::scene
