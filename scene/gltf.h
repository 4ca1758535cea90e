#pragma once
// Loads glTF 2.0. The loader checks every index, range, stride, count and number before use.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "scene/light_adjustments.h"
#include "scene/light_links.h"
#include "scene/light_profiles.h"
#include "scene/scene.h"
#include "scene/visibility_rules.h"

namespace gatelight::scene {

/// The treatment of back faces of materials that are neither doubleSided nor transparent.
enum class BackFaces : std::uint8_t {
  show,   ///< they are visible and reflect, but do not emit
  cull,   ///< rays pass them, as the specification requires
  light,  ///< they are visible, reflect and emit, as the front
};

/// The value of LoadOptions::animation for no animation.
inline constexpr const char* kNoAnimation = "none";

struct LoadOptions {
  int scene = -1;       ///< index of the glTF scene; -1 means the file's default, or its first
  std::string variant;  ///< name of a KHR_materials_variants variant; empty means the default materials
  std::optional<double> time;  ///< in seconds, for the animations; without it, nodes keep their static pose
  /// Exposure time in seconds, centred on `time` (Scene::shutter); 0 means no motion blur.
  double shutter = 0.0;
  /// Name or index of the animation to evaluate. Empty means all of them; if several animate the same value,
  /// only the first does.
  std::string animation;
  bool missing_is_error = true;  ///< for unreadable textures; otherwise they are left out, with a warning
  bool allow_external = false;   ///< buffers and images may lie outside the scene file's folder
  std::vector<std::string> ignore_required;  ///< extensions that the file may require although unsupported
  bool show_hidden = false;                  ///< show the nodes that KHR_node_visibility hides
  BackFaces back_faces = BackFaces::show;
  std::vector<LightAdjustment> lights;     ///< applied to the loaded scene in this order
  std::vector<LightProfile> profiles;      ///< likewise
  std::vector<VisibilityRule> visibility;  ///< likewise
  std::vector<LightLinkRule> light_links;  ///< likewise
  bool bake_transforms = true;             ///< see scene/bake.h; if false, every instance stays an instance
  int threads = 0;                         ///< 0: as many as the machine and the control group allow
};

/// A scene farther from the file's origin than this many times its radius is moved to its centre, in double
/// precision (Scene::origin). Rays start a few units in the last place of the coordinates off a surface; at
/// this distance, that is 1/30 000 of the radius.
inline constexpr double kFarFromOrigin = 16.0;

/// An open file whose scene can be evaluated at many times. Static data is read only once.
class SceneFile {
 public:
  /// Throws as load_gltf() does.
  explicit SceneFile(const std::filesystem::path& path, const LoadOptions& options = {});
  ~SceneFile();

  /// Returns the scene at the options' time. Call it only once.
  Scene load();
  /// load() in two steps. Between them, a program may change materials, lights, cameras, vertices and
  /// transforms. Call read() only once. finish() may be called for several copies of its scene; show()
  /// accepts only the last of them.
  Scene read();
  void finish(Scene& scene);
  /// Updates the scene from load() to another time. The result is bit-identical to load_gltf() at that time.
  /// Nothing moves unless the options have a time. Throws as load_gltf() does; the scene is then invalid
  /// until a later call succeeds.
  void show(Scene& scene, double seconds);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Loads a .gltf or .glb file. Throws InputError if the file cannot be read, violates the specification in a
/// way that affects pictures, or requires an unsupported extension; OutOfMemory if the threads cannot be
/// started. Scene, warnings and errors do not depend on the number of threads.
Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace gatelight::scene
