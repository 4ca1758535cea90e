#pragma once
// Renders pictures of one scene.

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
  int spp = 0;                  ///< kUnlimitedSpp: another limit decides
  double samples = 0.0;         ///< per pixel, including the current pass
  std::optional<double> error;  ///< estimated error, if max_error is set
  double fraction = 0.0;        ///< finished part of the phase, in [0, 1]
  double seconds = 0.0;         ///< wall time since scouting or rendering started
};

/// Thrown after Callbacks::abandon returned true.
class Abandoned : public std::exception {
 public:
  const char* what() const noexcept override { return "the picture was given up"; }
};

struct Callbacks {
  /// Called by a worker thread, at most about ten times per second.
  std::function<void(const Progress&)> progress;
  /// Called by worker threads between tiles, also concurrently. When it returns true, the current pass is
  /// finished and rendering stops.
  std::function<bool()> stop;
  /// Like `stop`, for a picture that is no longer wanted. When it returns true, render() and render_frame()
  /// throw Abandoned as soon as possible. The cache of frames keeps its training.
  std::function<bool()> abandon;
  /// Called after every pass. When it returns true, `snapshot` receives the picture so far. Only spp and
  /// render_seconds of the statistics are up to date at that time.
  std::function<bool()> snapshot_wanted;
  std::function<void(const Picture&)> snapshot;
  /// Called when a checkpoint or the cache file could not be written; rendering continues. `again` says
  /// whether the write will be retried. Without this callback, the exception ends the render.
  std::function<void(const std::exception_ptr& error, bool again)> output_failed;

  /// Throws Abandoned if `abandon` returns true.
  void check_abandoned() const {
    if (abandon && abandon()) throw Abandoned();
  }
};

/// The training steps or samples per pixel at which one run makes pictures. They are ascending, not empty,
/// and replace train_steps or spp of RenderOptions.
struct Series {
  std::vector<int> train_steps;  ///< nao and nrc: in addition to those of a loaded cache; 0 means untrained
  std::vector<int> spp;          ///< path and ao: samples per pixel
};

/// `statistics` are those of a run that ends at this point. For nao and nrc, they cover the training up to
/// this point, without the time of earlier pictures, and the rendering of this picture. For path and ao, they
/// cover the rendering up to this point.
using SeriesPicture =
    std::function<void(int point, const Picture& picture, const RenderStatistics& statistics)>;

/// The status in a file of Renderer::write_frame() or in another cache file.
struct FrameStatus {
  std::optional<int> frame;       ///< the last rendered one
  double layout_seconds = 0.0;    ///< time of the scene when the cache was laid out
  std::optional<float> exposure;  ///< of displayed frames, in stops
  bool of_animation = false;      ///< else the scene is the static pose
};

/// Throws CacheFileError.
FrameStatus read_frame_status(const std::filesystem::path& path);

struct CacheReport;  // cache/cache_report.h

/// Owns the data that is built once for a scene (acceleration structure, lights, textures) and renders
/// pictures from it.
class Renderer {
 public:
  /// The scene must outlive the renderer. Throws OutOfMemory, Unavailable, BadOption, or, if the environment
  /// cannot be read, InputError with the name of the file. If several processes make one picture together,
  /// each holds the scene, and all call the same functions with the same options; threads and memory limits
  /// may differ.
  Renderer(const scene::Scene& scene, const RenderOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// Changes the view of all later pictures. Nothing is rebuilt; the cache is trained again for the new view.
  /// Throws BadOption as the constructor does; the view is then unchanged.
  void set_camera(const CameraOptions& camera);

  /// Whether a soft sky lights the current view; nullopt if this cannot change with the view or the time.
  std::optional<bool> soft_sky() const;
  /// Decides whether all pictures after the next change of view, time or options have the soft sky. With
  /// nullopt, each view decides for itself, as in a new renderer.
  void keep_soft_sky(std::optional<bool> sky);

  /// Changes the options of all later pictures, except processes and the number of threads. Rebuilds only
  /// what the change affects. Frames keep their cache, whose options must not change. Throws as the
  /// constructor does; in that case, set valid options before using the renderer again.
  void set_options(const RenderOptions& options);

  // Frames of an animation: scene::SceneFile::show() changes the scene between these calls.

  /// Call it after the scene has changed to another time. Rebuilds the moving parts. Throws as the
  /// constructor does.
  void scene_moved(const CameraOptions& camera);
  /// Includes the surfaces visible from the current view, at the current time, in the cache. Call it for some
  /// frames before begin_frames(); without a call, only the current frame is included.
  void scout();
  /// Begins a sequence of frames. Creates the cache that they share, or reads it from `file`, which must
  /// belong to this scene. `seconds` is the current time of the scene. Throws the exceptions of render().
  void begin_frames(double seconds, const std::filesystem::path& file = {});
  /// Continues after the last frame of `file`: reads its cache and samples. The scene and the view must be
  /// those of that frame.
  void restore_frame(const std::filesystem::path& file);
  /// Records the positions of the current scene as those of `frame`, a neighbour of the next rendered frame,
  /// for Aov::motion and Aov::motion_next. Rebuilds nothing: call scene_moved() afterwards. Motion to unknown
  /// frames is zero.
  void note_frame(int frame, const CameraOptions& camera);
  /// Whether the positions of `frame` are known or not needed. The last frames rendered with these layers are
  /// known. Processes that do not write the picture need none.
  bool knows_frame(int frame) const;
  /// Renders the current frame. `frame` selects its random numbers. The picture depends on the scene, the
  /// options and the state of the cache, which is trained further; the more the light has changed, the
  /// longer. Checkpoints are neither read nor written.
  Picture render_frame(int frame, const Callbacks& callbacks = {});
  /// Writes the state that the next frame needs. Throws OutputError.
  void write_frame(const std::filesystem::path& path, std::optional<float> exposure) const;

  /// Renders the picture. The same scene, options and Embree ISA give the same bits for any number of threads
  /// and processes, unless a time limit ends the render or the first picture chooses another device
  /// (CacheOptions::choose_device). The first of several processes gets the picture and writes the files, and
  /// the others get an empty picture; a stop request to one of them stops all.
  Picture render(const Callbacks& callbacks = {});
  /// Calls `picture` for each point, in order. The picture has the bits that render() gives with these steps
  /// or samples. Returns false if callbacks.stop ends the series early; `picture` is not called for the
  /// remaining points. Throws BadOption if the series is invalid, if the options contain a time limit,
  /// max_error, checkpoints or cache_out, or with several processes.
  bool render_series(const Series& series, const SeriesPicture& picture, const Callbacks& callbacks = {});
  /// Describes the cache that rendering would build. Scouts, but neither trains nor renders. Only for
  /// integrators with a cache.
  CacheReport report_cache();
  /// Like report_cache(), but without reports of single instances and without the size of the cache before
  /// scouting.
  CacheStatistics set_up_cache();
  /// The options that may be chosen for the scene, as all pictures have them.
  ChosenOptions chosen() const;
  const RenderStatistics& statistics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace gatelight::renderer
