#pragma once
// The group of each light of a picture (`light-groups`).

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/light/lights.h"
#include "renderer/settings/light_group_options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Groups are numbered as they are given; lights that none of them names are in one more, the last.
class LightGroups {
 public:
  /// Without groups. The functions that return a group must not be called.
  LightGroups() = default;
  /// Throws BadOption for a name that no light has, and for a light in two groups.
  LightGroups(const std::vector<LightGroup>& groups, const scene::Scene& scene, const Lights& lights);

  bool empty() const { return names_.empty(); }
  std::size_t size() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }

  /// The groups of all instances and lights, for comparisons.
  std::vector<std::uint8_t> members() const;
  /// The group of an instance that emits, or that shows its own colour (unlit).
  std::size_t of_instance(std::uint32_t instance) const { return of_instance_[instance]; }
  std::size_t of_environment() const { return of_others_.back(); }
  /// The group of LightSample::light.
  std::size_t of_light(const EmissiveTriangles& triangles, std::uint32_t light) const {
    return light < triangles.size() ? of_instance_[triangles[light].instance]
                                    : of_others_[light - triangles.size()];
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::uint8_t> of_instance_;
  std::vector<std::uint8_t> of_others_;  ///< groups of the lights after the triangles, by their numbers
};

}  // namespace gatelight::renderer
