#pragma once
// The lights of a scene in the form of the kernels.

#include <vector>

#include "renderer/light/lights.h"
#include "renderer/shading/kernels.h"

namespace gatelight::renderer {

/// Copies its data, except the tree. The lights must outlive it.
class LightArrays {
 public:
  explicit LightArrays(const Lights& lights);
  LightArrays(const LightArrays&) = delete;
  LightArrays& operator=(const LightArrays&) = delete;

  /// Null where the kernels do not support the selection of lights, or lights that move while the shutter is
  /// open.
  const LightArraysPtr* view() const { return usable_ ? &view_ : nullptr; }
  /// The view of the lights of Lights::sample_delta. view() must not be null.
  LightArraysPtr delta_view() const;
  /// Whether the kernels complete all samples: there is no picture of the sky, no textured emitter and no
  /// profile.
  bool complete() const { return complete_; }
  std::size_t bytes() const { return (triangles_.size() + placed_.size() + suns_.size()) * sizeof(float); }

 private:
  bool usable_;
  bool complete_ = true;
  LightArraysPtr view_;
  const LightTree* placed_tree_;
  std::vector<float> triangles_;
  std::vector<float> placed_;
  std::vector<float> suns_;
};

}  // namespace gatelight::renderer
