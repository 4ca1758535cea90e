#pragma once
// A scene that Python may change, and finished copies of it for renderers.

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "apps/settings/render_settings.h"
#include "scene/gltf.h"
#include "scene/scene.h"

namespace gatelight::python {

/// What a change of the scene changes. Only a thread with Python's lock touches it.
struct SceneContent {
  /// As it was read or made: meshes in their own space, nothing baked. Arrays of meshes never move, because
  /// views of NumPy point into them.
  scene::Scene source;
  std::vector<char> own_meshes;  ///< for each mesh, whether it was made of arrays
  std::optional<double> shown;   ///< time of show(), else that of the options
};

struct SceneData : SceneContent {
  std::unique_ptr<scene::SceneFile> file;
  std::mutex file_mutex;
  apps::RenderSettings loading;  ///< the options that it was loaded with
  double load_seconds = 0.0;
  std::uint64_t revision = 0;                    ///< of all above
  std::shared_ptr<const scene::Scene> finished;  ///< of this revision, where there is one

  void change() {
    ++revision;
    finished.reset();
  }
};

using ScenePointer = std::shared_ptr<SceneData>;

/// Opens a file with the options of load().
ScenePointer load_scene(const std::string& path, const pybind11::dict& keywords);

/// The scene for a renderer, of a copy that was made with Python's lock: meshes made of arrays are completed
/// as those of a file are, then the last steps of loading. Runs without the lock. Throws InputError.
scene::Scene finish_scene(SceneData& data, SceneContent copy);

/// The same, kept until the scene changes. Call it with Python's lock.
std::shared_ptr<const scene::Scene> finished_scene(const ScenePointer& data);

}  // namespace gatelight::python
