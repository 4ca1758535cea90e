#pragma once
// The scene of a window with its cache, and a thread that makes pictures of it for every viewer.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/view/live_flags.h"
#include "apps/view/live_scene.h"
#include "apps/view/picture_ladder.h"
#include "apps/view/scene_outline.h"
#include "base/clock.h"
#include "renderer/render.h"

namespace gatelight::apps {

/// A picture that a viewer has got. It does not change.
struct ShownPicture {
  std::uint64_t version = 0;   ///< counts the pictures of a session
  std::uint64_t revision = 0;  ///< of the viewer's flags
  Stage stage = Stage::none;
  bool complete = false;  ///< of a final picture: it has all its samples
  renderer::Picture picture;
  renderer::RenderStatistics statistics;
  RenderSettings settings;
  double seconds = 0.0;   ///< since the flags changed
  float exposure = 0.0f;  ///< in stops, by which it is shown
};

/// How far the present picture of a viewer is.
struct ViewerStatus {
  std::uint64_t revision = 0;
  std::uint64_t version = 0;
  Stage stage = Stage::none;  ///< that is being made
  bool complete = false;
  bool waits = false;  ///< the renderer works for another viewer
  renderer::Progress progress;
  std::string error;  ///< why there is no picture of the present flags; else empty
};

class ViewSession {
 public:
  /// Loads the scene and builds what all pictures share. `words`: flags of `gatelight render`. Throws what
  /// loading and Renderer's constructor throw.
  ViewSession(const std::string& scene, std::vector<std::string> words);
  ~ViewSession();
  ViewSession(const ViewSession&) = delete;
  ViewSession& operator=(const ViewSession&) = delete;

  const std::string& file() const { return file_; }
  const std::vector<std::string>& words() const { return words_; }

  // Any thread may call what follows. A viewer is made where its name is new.

  /// Of loading and building: input that was not taken literally.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// What the file has, as it was loaded.
  const SceneOutline& outline() const { return outline_; }
  /// Changes flags of a viewer, and the layer that it shows (empty: as before; "none": the picture). Returns
  /// the new revision. Throws UsageError, with nothing changed.
  std::uint64_t change(const std::string& viewer, const FlagChange& flags, const std::string& layer);
  LiveFlags flags(const std::string& viewer);
  ViewerStatus status(const std::string& viewer);
  /// The viewer's last picture, once it is later than `version`, or null after `most`.
  std::shared_ptr<const ShownPicture> wait(const std::string& viewer, std::uint64_t version,
                                           std::chrono::milliseconds most);
  /// Its last picture with all layers; null before the first one.
  std::shared_ptr<const ShownPicture> last_whole(const std::string& viewer);
  /// Ends the waiting of all callers.
  void stop();

 private:
  struct Viewer {
    LiveFlags flags;
    std::string layer;
    RenderSettings settings;
    std::uint64_t revision = 1;
    Stage reached = Stage::none;
    Clock::time_point changed = Clock::now();
    Clock::time_point seen = Clock::now();  ///< when it was last asked for
    std::shared_ptr<const ShownPicture> shown, whole;
    ViewerStatus status;
  };
  /// What the thread makes next.
  struct Task {
    std::string viewer;
    Stage stage = Stage::none;
    std::uint64_t revision = 0;
    std::uint64_t changes = 0;  ///< of all viewers, before it
    RenderSettings settings;
    std::string layer;
    Clock::time_point changed;
  };

  Viewer& viewer(const std::string& name);
  void run();
  std::optional<Task> next_task();
  bool is_due(const Viewer& viewer) const;
  /// Whether a picture should be given up for a more urgent one.
  bool is_overtaken(const Task& task);
  void make(const Task& task);
  renderer::Callbacks callbacks(const Task& task);
  renderer::RenderOptions options_of(const Task& task) const;
  void prepare(const Task& task);
  void publish(const Task& task, renderer::Picture picture, bool complete);
  void fail(const Task& task);

  const std::string file_;
  const std::vector<std::string> words_;
  RenderSettings base_;
  std::vector<std::string> warnings_;
  std::mutex renders_;  ///< held while the scene or the renderer is used
  LiveScene scene_;
  const SceneOutline outline_;
  std::optional<renderer::Renderer> renderer_;
  std::optional<renderer::Integrator> integrator_;  ///< that was chosen for the scene
  bool shares_cache_ = false;                       ///< the frames have begun
  renderer::EnvironmentOptions environment_;        ///< of the last picture
  bool new_light_ = true;                           ///< that the cache has not learned yet
  bool broken_ = false;                             ///< the renderer was given options that it could not take
  int frame_ = 0;
  double divisor_ = 4.0;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable work_, news_;
  std::map<std::string, Viewer> viewers_;
  std::uint64_t version_ = 0;
  std::atomic<std::uint64_t> changes_ = 0;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace gatelight::apps
