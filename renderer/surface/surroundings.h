#pragma once
// The media in which the rays of a camera start.

#include <vector>

#include "base/math.h"
#include "renderer/surface/accel.h"
#include "renderer/surface/media.h"
#include "renderer/surface/surface.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The bodies of glass or liquid around places. Thread-safe after construction; holds references to its
/// arguments.
class Surroundings {
 public:
  /// `places`: bounds of the points of later calls.
  Surroundings(const scene::Scene& scene, const Media& media, const Accel& accel, const Surfaces& surfaces,
               const Box& places);

  /// Whether no body is near, so that all places are outside of them.
  bool empty() const { return bodies_.empty(); }
  /// What fills the space at a point, at a time of the shutter. One ray finds it, in the direction in which
  /// it leaves the bodies.
  StartMedium at(const Vec3& point, float time) const;

 private:
  struct Body {
    std::uint32_t volume;  ///< of Media; or kNoVolume
    std::uint32_t instance;
  };
  static constexpr int kNone = -1;

  const scene::Scene& scene_;
  const Accel& accel_;
  const Surfaces& surfaces_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_;  ///< by instance; kNone for others
};

}  // namespace gatelight::renderer
