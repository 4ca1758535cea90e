#pragma once
// One picture from one scene. The only thing an application has to call.

#include <functional>
#include <memory>
#include <stdexcept>

#include "renderer/options.h"
#include "renderer/picture.h"
#include "renderer/statistics.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// More memory than there is or than the limit allows. The message holds the bytes needed and allowed.
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A non-finite sample under NanPolicy::error. The message locates it.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device or instruction set asked for is not there.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An option that no scene can satisfy (an unknown camera, an empty region). The message names value and
/// choices.
struct BadOption : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

struct Progress {
  int spp_done = 0;
  int spp = 0;
  double fraction = 0.0;  ///< of the work, in [0, 1]
  double seconds = 0.0;   ///< since rendering started
};

struct Callbacks {
  /// Called from a worker at most some ten times a second.
  std::function<void(const Progress&)> progress;
  /// Asked between tiles. When it answers true the current pass is finished and rendering stops.
  std::function<bool()> stop;
  /// Asked after every pass; when it answers true, `snapshot` receives the picture so far.
  std::function<bool()> snapshot_wanted;
  std::function<void(const Picture&)> snapshot;
};

/// Holds what was built for a scene (acceleration structure, lights, textures), so that several pictures can
/// be made of it.
class Renderer {
 public:
  /// Builds. The scene must outlive the renderer. Throws OutOfMemory, Unavailable, BadOption, or
  /// std::runtime_error naming the file where the environment cannot be read.
  Renderer(const scene::Scene& scene, const RenderOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// Renders. The same scene, options and Embree ISA give the same bits for any number of threads.
  Picture render(const Callbacks& callbacks = {});
  const RenderStatistics& statistics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Bytes that vertices, BVH, textures and film of this scene are expected to need, before anything is built.
std::size_t estimate_memory(const scene::Scene& scene, const RenderOptions& options);

}  // namespace gatelight::renderer
