#pragma once
// Makes pictures of one scene. An application needs no other header to render.

#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "renderer/image/picture.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "scene/scene.h"

namespace gatelight::renderer {

enum class Phase : std::uint8_t { scout, train, render, denoise };

struct Progress {
  Phase phase = Phase::render;
  int steps_done = 0;  ///< training steps
  int steps = 0;
  double loss = 0.0;
  int spp_done = 0;
  int spp = 0;                  ///< kUnlimitedSpp: time decides
  double samples = 0.0;         ///< per pixel, with those of the pass that is under way
  std::optional<double> error;  ///< estimated, with max_error
  double fraction = 0.0;        ///< how much of the phase is done, in [0, 1]
  double seconds = 0.0;         ///< wall time since scouting or rendering started
};

/// Ends a picture that Callbacks::abandon gave up.
class Abandoned : public std::exception {
 public:
  const char* what() const noexcept override { return "the picture was given up"; }
};

struct Callbacks {
  /// A worker thread calls it about ten times a second at most.
  std::function<void(const Progress&)> progress;
  /// Worker threads call it between tiles, several at once. When it returns true, the current pass is
  /// finished and rendering stops.
  std::function<bool()> stop;
  /// Like `stop`, for a picture that is not wanted any more. When it returns true, render() and
  /// render_frame() end as soon as they can, with Abandoned. The cache of frames keeps what it has learned.
  std::function<bool()> abandon;
  /// Called after every pass. When it returns true, `snapshot` receives the picture so far. Only spp and
  /// render_seconds of the statistics are up to date at that time.
  std::function<bool()> snapshot_wanted;
  std::function<void(const Picture&)> snapshot;
  /// A checkpoint or the cache file could not be written, and the render goes on. `again` says whether the
  /// write will be tried again. Where this callback is not set, the exception ends the render.
  std::function<void(const std::exception_ptr& error, bool again)> output_failed;

  /// Throws Abandoned where the picture is given up.
  void check_abandoned() const {
    if (abandon && abandon()) throw Abandoned();
  }
};

/// The points of one training, or of one plain rendering, at which pictures are made. They are ascending and
/// not empty. They replace train_steps or spp of RenderOptions.
struct Series {
  std::vector<int> train_steps;  ///< nao and nrc: beyond those of a loaded cache; 0 is untrained
  std::vector<int> spp;          ///< path and ao: samples per pixel
};

/// `statistics` are those of a run that ends at this point. For nao and nrc they hold the training up to the
/// point, with only the time of training, and the rendering of this picture. For path and ao they hold the
/// rendering up to the point.
using SeriesPicture =
    std::function<void(int point, const Picture& picture, const RenderStatistics& statistics)>;

/// What a file of Renderer::write_frame() says of itself, or another cache file.
struct FrameStatus {
  std::optional<int> frame;       ///< the last one, whose light it has
  double layout_seconds = 0.0;    ///< time of the scene that the cache belongs to
  std::optional<float> exposure;  ///< of displayed frames, in stops
  bool of_animation = false;      ///< else the scene is that of the file's nodes
};

/// Throws CacheFileError.
FrameStatus read_frame_status(const std::filesystem::path& path);

struct CacheReport;  // cache/cache_report.h
class Ranks;         // distributed/ranks.h

/// Owns the data that is built once for a scene (acceleration structure, lights, textures) and renders
/// pictures from it.
class Renderer {
 public:
  /// The scene must outlive the renderer. Throws OutOfMemory, Unavailable, BadOption, or InputError
  /// that names the file when the environment cannot be read.
  Renderer(const scene::Scene& scene, const RenderOptions& options);
  /// One of several processes, which must outlive the renderer, that make one picture together. Each holds
  /// the scene, and all call the same functions with the same options; threads and memory limits may differ.
  Renderer(const scene::Scene& scene, const RenderOptions& options, Ranks& ranks);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// The pictures from now on have another view; nothing is built again. A cache is trained anew for it.
  /// Throws BadOption as the constructor does, with the view unchanged.
  void set_camera(const CameraOptions& camera);

  /// Whether a soft sky lights the present view; nothing where no view or time of the scene can change that.
  std::optional<bool> soft_sky() const;
  /// The pictures after the next call that changes view, time or options all have the soft sky, or all have
  /// none; nothing: each view chooses for itself, by what it shows, as a new renderer does.
  void keep_soft_sky(std::optional<bool> sky);

  /// The pictures from now on have other options, with as many threads as before. What does not depend on the
  /// difference is not built again; frames go on with their cache, whose options must be the same. Throws as
  /// the constructor does; the renderer is then to be given other options before it is used.
  void set_options(const RenderOptions& options);

  // Frames of an animation: scene::SceneFile::show() changes the scene between these calls.

  /// The scene shows another time. Builds what moves. Throws as the constructor does.
  void scene_moved(const CameraOptions& camera);
  /// What the present view shows at the present time is to be part of the cache. Call it for some frames
  /// before begin_frames(); without a call the present one is taken.
  void scout();
  /// Begins the frames. Makes the cache that they share, or reads that of `file`, whose scene this must be
  /// then: `seconds` is the time that the scene shows. Throws the exceptions of render().
  void begin_frames(double seconds, const std::filesystem::path& file = {});
  /// Takes the light of the last frame of `file`, whose scene and view these must be, for the next one.
  void restore_frame(const std::filesystem::path& file);
  /// Keeps the places of the present scene as those of a frame beside the one that is rendered next, for
  /// Aov::motion and Aov::motion_next. Nothing is built: the renderer needs scene_moved() after it. Where
  /// these frames are not known there is no motion.
  void note_frame(int frame, const CameraOptions& camera);
  /// Whether they are known; those of the last frames that were rendered with these layers are. Where another
  /// process makes the layers, they need not be.
  bool knows_frame(int frame) const;
  /// The present frame, whose number keys its random numbers. It depends on scene, options and the cache
  /// before it, which it trains further, as much as the light has changed. No checkpoint is read or written.
  Picture render_frame(int frame, const Callbacks& callbacks = {});
  /// Writes what the next frame needs of those before. Throws OutputError.
  void write_frame(const std::filesystem::path& path, std::optional<float> exposure) const;

  /// The same scene, options and Embree ISA give the same bits for any number of threads and of ranks, unless
  /// a time limit ends it. Where there are several ranks, rank 0 gets the picture and writes the files, and
  /// the others get an empty picture; a stop request to one of them stops all.
  Picture render(const Callbacks& callbacks = {});
  /// Calls `picture` for each point, in order. The picture has the bits that render() gives with these steps
  /// or samples. Returns false when callbacks.stop ends it before the last point; `picture` is not called for
  /// the points that remain. Throws BadOption for points that are not a valid series, and when the options
  /// have a time limit, max_error, checkpoints or cache_out, and with several ranks.
  bool render_series(const Series& series, const SeriesPicture& picture, const Callbacks& callbacks = {});
  /// Describes the cache that rendering would build. Scouts, but neither trains nor renders. Only for
  /// integrators with a cache.
  CacheReport report_cache();
  /// Like report_cache(), but without the report of each instance and without the size of a cache that is not
  /// scouted.
  CacheStatistics set_up_cache();
  /// The integrator of the options, or the one chosen for the scene (RenderOptions::choose_integrator).
  Integrator integrator() const;
  const RenderStatistics& statistics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace gatelight::renderer
