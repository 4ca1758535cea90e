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
#include "scene/light_profiles.h"
#include "scene/scene.h"

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
  std::optional<double> time;  ///< seconds: the moment of the file's animations; none: the pose of its nodes
  /// Seconds that a shutter is open, with `time` in the middle (Scene::shutter); 0: nothing is blurred.
  double shutter = 0.0;
  /// Name of the animation that `time` shows, else its index. Empty: all of them together, but of those that
  /// animate the same value only the first.
  std::string animation;
  bool missing_is_error =
      true;                     ///< an unreadable texture is an error; else white replaces it, with a warning
  bool allow_external = false;  ///< buffers and images may lie outside the scene file's folder
  std::vector<std::string> ignore_required;  ///< extensions that the file may require although unsupported
  bool show_hidden = false;                  ///< show the nodes that KHR_node_visibility hides
  BackFaces back_faces = BackFaces::show;
  std::vector<LightAdjustment> lights;  ///< applied to the loaded scene, in this order
  std::vector<LightProfile> profiles;   ///< likewise
  bool bake_transforms = true;          ///< see scene/bake.h; if false, every instance stays an instance
  int threads = 0;                      ///< 0: as many as the machine and the control group allow
};

/// A scene farther from the file's origin than this many times its radius is moved to its centre, in double
/// precision (Scene::origin). Rays start a few units in the last place of the coordinates off a surface; at
/// this distance that is a 30 000th of the radius.
inline constexpr double kFarFromOrigin = 16.0;

/// A file that stays open, to show its scene at many times. What does not move is read once.
class SceneFile {
 public:
  /// Throws as load_gltf() does.
  explicit SceneFile(const std::filesystem::path& path, const LoadOptions& options = {});
  ~SceneFile();

  /// The scene at the options' time, for a single call.
  Scene load();
  /// load() in two parts, between which a program may change materials, lights, cameras, vertices and
  /// transforms. read() is for a single call; finish() may be called for several copies of its scene, of
  /// which show() takes the last one.
  Scene read();
  void finish(Scene& scene);
  /// Changes the scene that load() gave to another time, to the bits that load_gltf() gives for it. The
  /// options need a time, else nothing moves. Throws as load_gltf() does, with the scene in any state, which
  /// a later call mends.
  void show(Scene& scene, double seconds);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Loads a .gltf or .glb file. Throws InputError if the file cannot be read, violates the specification in a
/// way that affects pictures, or requires an unsupported extension; OutOfMemory where the threads cannot be
/// started. The same scene, warnings and errors for any number of threads.
Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace gatelight::scene
