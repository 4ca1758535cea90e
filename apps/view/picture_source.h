#pragma once
// What a page shows: pictures of a scene that are made while it is open, or a finished picture.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/view/live_flags.h"
#include "apps/view/picture_ladder.h"
#include "apps/view/scene_outline.h"
#include "base/clock.h"
#include "renderer/render.h"

namespace gatelight::apps {

/// A picture that a viewer has got. It does not change.
struct ShownPicture {
  std::uint64_t version = 0;   ///< counts the pictures of a source
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

/// Any thread may call its public functions. A viewer is made where its name is new.
class PictureSource {
 public:
  /// `words`: the flags of the command line.
  PictureSource(std::string file, std::vector<std::string> words);
  PictureSource(const PictureSource&) = delete;
  PictureSource& operator=(const PictureSource&) = delete;
  virtual ~PictureSource() = default;

  const std::string& file() const { return file_; }
  const std::vector<std::string>& words() const { return words_; }
  /// What the scene has, as it was loaded; null for a picture.
  virtual const SceneOutline* outline() const { return nullptr; }

  /// Changes flags of a viewer, and the layer that it shows (empty: as before; "none": the picture). Returns
  /// the new revision. Throws BadOption, with nothing changed.
  virtual std::uint64_t change(const std::string& viewer, const FlagChange& flags,
                               const std::string& layer) = 0;
  LiveFlags flags(const std::string& viewer);
  virtual ViewerStatus status(const std::string& viewer) = 0;
  /// The viewer's last picture, once it is later than `version`, or null after `most`.
  std::shared_ptr<const ShownPicture> wait(const std::string& viewer, std::uint64_t version,
                                           std::chrono::milliseconds most);
  /// Its last picture with all layers; null before the first one.
  std::shared_ptr<const ShownPicture> last_whole(const std::string& viewer);
  /// The command that makes the picture; empty where it is not known.
  virtual std::string command(const std::string& viewer) = 0;
  /// Ends the waiting of all callers.
  virtual void stop();

 protected:
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
  /// The caller holds the mutex.
  Viewer& viewer(const std::string& name);
  /// Completes a new viewer, with the mutex held.
  virtual void welcome(Viewer& made) = 0;

  const std::string file_;
  const std::vector<std::string> words_;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable news_;
  std::map<std::string, Viewer> viewers_;
  bool stopped_ = false;
};

}  // namespace gatelight::apps
