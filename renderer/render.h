#pragma once
// One picture from one scene. The only thing an application has to call.

#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/machine/errors.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "scene/scene.h"

namespace gatelight::renderer {

enum class Phase : std::uint8_t { scout, train, render };

struct Progress {
  Phase phase = Phase::render;
  int steps_done = 0;  ///< of training
  int steps = 0;
  double loss = 0.0;
  int spp_done = 0;
  int spp = 0;
  double fraction = 0.0;  ///< of the phase, in [0, 1]
  double seconds = 0.0;   ///< since scouting or rendering started
};

struct Callbacks {
  /// Called from a worker at most some ten times a second.
  std::function<void(const Progress&)> progress;
  /// Asked between tiles, by several workers at once. When it answers true the current pass is finished and
  /// rendering stops.
  std::function<bool()> stop;
  /// Asked after every pass; when it answers true, `snapshot` receives the picture so far. Of the statistics,
  /// spp and render_seconds are up to date then.
  std::function<bool()> snapshot_wanted;
  std::function<void(const Picture&)> snapshot;
  /// A checkpoint or the cache file could not be written: the picture goes on. `again`: it will be tried
  /// again. Where this is not set, the exception ends the render.
  std::function<void(const std::exception_ptr& error, bool again)> output_failed;
};

/// The points at which pictures are wanted of one training, or of one plain rendering. Ascending, not empty;
/// RenderOptions's own train_steps or spp does not count then.
struct Series {
  std::vector<int> train_steps;  ///< of nao and nrc, beyond those of a loaded cache; 0: an untrained one
  std::vector<int> spp;          ///< of path and ao
};

/// `statistics` are those that a run which ended at this point would have had: training up to there, with
/// the time that it took alone, and its own picture. Of path and ao rendering up to there.
using SeriesPicture =
    std::function<void(int point, const Picture& picture, const RenderStatistics& statistics)>;

struct CacheReport;  // cache/cache_report.h

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
  /// Calls `picture` with the picture of each point, in order. It has the bits that render() gives with these
  /// steps or samples. Answers false when callbacks.stop ended it before the last point; a point that was not
  /// reached is not called. Throws BadOption for points that make no series, and for limits of time,
  /// checkpoints and cache_out.
  bool render_series(const Series& series, const SeriesPicture& picture, const Callbacks& callbacks = {});
  /// What the cache would be: scouts, but neither trains nor renders. For integrators with a cache.
  CacheReport report_cache();
  /// The same without instances, and without the cache that it is compared with.
  CacheStatistics set_up_cache();
  const RenderStatistics& statistics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace gatelight::renderer
