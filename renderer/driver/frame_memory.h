#pragma once
// What the frames of an animation hand on to each other.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/cache/cache_session.h"
#include "renderer/cache/scouting.h"
#include "renderer/denoise/denoise.h"
#include "renderer/driver/prepared_picture.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/temporal/history.h"
#include "renderer/temporal/light_probes.h"

namespace gatelight::renderer {

struct FrameMemory {
  Scouting scouting;
  bool scouted = false;
  int frame = 0;  ///< that is made
  std::optional<int> last_frame;
  int fresh_steps = 0;  ///< training steps of a cache that knows nothing
  double layout_seconds = 0.0;
  SceneFingerprint fingerprint;         ///< of the scene in which the cache was laid out
  std::unique_ptr<CacheSession> cache;  ///< null without a cache, and while a frame uses it

  std::unique_ptr<History> history;  ///< of the last frame that was denoised; null before the first one

  /// The film's samples with the light of the frame before. For the caller's arena.
  Reuse reuse(const PreparedPicture& picture, const Film& film);
  /// The layers of motion. Keeps the frame's view for its neighbours. For the caller's arena.
  std::vector<Layer> motion(const PreparedPicture& picture);
  /// Keeps a view of the present scene.
  void note_view(const PreparedPicture& picture, const View& view, int frame);
  /// Forgets pictures of another size.
  void forget() {
    history.reset();
    views_.clear();
  }
  bool knows_view(int of_frame) const { return views_.contains(of_frame); }
  /// Keeps the frame for the next one.
  void keep(const PreparedPicture& picture, const std::vector<float>& denoised, const Reuse& reuse);
  /// Renderer::begin_frames().
  void begin(const PreparedPicture& picture, const RecordExchange& exchange, double seconds,
             const std::filesystem::path& file);
  /// Renderer::restore_frame().
  void restore(const PreparedPicture& picture, const std::filesystem::path& file);
  /// Renderer::write_frame().
  void write(const PreparedPicture& picture, const std::filesystem::path& path,
             std::optional<float> exposure) const;

 private:
  std::map<int, PreviousView> views_;  ///< by frame, in the picture's own pixels
};

/// Training steps of a new cache that frames share.
int steps_of_frames(const PreparedPicture& picture);

/// The part of `steps` that a frame trains because `change` of the light was found (cache/light_change.h).
int steps_after_change(double change, int steps);

/// Whether a cache has learned so different a light that it is worth less than none.
bool begins_anew(double change);

}  // namespace gatelight::renderer
