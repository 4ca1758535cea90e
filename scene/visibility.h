#pragma once
// Which rays see an object, and which objects a light concerns.

#include <cstdint>
#include <vector>

namespace gatelight::scene {

/// Kinds of rays, as bits. A ray that has left a surface is of the kind of the lobe that it follows; clear
/// panes leave the kind as it is. Shadow rays go from surfaces and media to light samples.
using RayKinds = std::uint8_t;
inline constexpr RayKinds kCameraRays = 1;
inline constexpr RayKinds kDiffuseRays = 2;  ///< reflected by diffuse lobes
inline constexpr RayKinds kGlossyRays = 4;   ///< reflected by all other lobes
inline constexpr RayKinds kTransmissionRays = 8;
inline constexpr RayKinds kVolumeRays = 16;  ///< scattered by media
inline constexpr RayKinds kShadowRays = 32;
inline constexpr RayKinds kBounceRays = kDiffuseRays | kGlossyRays | kTransmissionRays | kVolumeRays;
inline constexpr RayKinds kAllRays = kCameraRays | kBounceRays | kShadowRays;

struct RayKindName {
  const char* name;
  RayKinds kind;
};
inline constexpr RayKindName kRayKindNames[] = {{"camera", kCameraRays}, {"diffuse", kDiffuseRays},
                                                {"glossy", kGlossyRays}, {"transmission", kTransmissionRays},
                                                {"volume", kVolumeRays}, {"shadow", kShadowRays}};

/// The name of the environment, including its sun, among those of objects and lights.
inline constexpr const char* kEnvironmentWord = "environment";

struct Visibility {
  RayKinds rays = kAllRays;     ///< that see it; others pass
  bool holdout = false;         ///< the camera sees a hole: black, with alpha 0
  bool shadow_catcher = false;  ///< the camera sees only the shadows on it

  bool operator==(const Visibility&) const = default;
};

/// The light of an object, a lamp or the environment; indices into Scene::object_sets, where -1 means all.
struct LightLink {
  int receivers = -1;  ///< it lights only these
  int blockers = -1;   ///< only these cast shadows in it

  bool operator==(const LightLink&) const = default;
  bool any() const { return receivers >= 0 || blockers >= 0; }
};

/// The most different sets that the lights of a scene may have.
inline constexpr int kMaxReceiverSets = 64;
inline constexpr int kMaxBlockerSets = 25;

/// A set of objects.
struct ObjectSet {
  std::vector<std::uint8_t> instances;  ///< 1 for members; one entry for each of Scene::instances
  bool fog = false;                     ///< whether fog, which is no object, is a member

  bool operator==(const ObjectSet&) const = default;
};

}  // namespace gatelight::scene
