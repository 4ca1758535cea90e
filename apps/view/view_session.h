#pragma once
// The scene of a window with its cache, and a thread that makes pictures of it for every viewer.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/view/live_scene.h"
#include "apps/view/picture_source.h"
#include "base/clock.h"
#include "renderer/render.h"

namespace gatelight::apps {

class ViewSession : public PictureSource {
 public:
  /// Loads the scene and builds what all pictures share. `words`: flags of `gatelight render`. Throws what
  /// loading and Renderer's constructor throw.
  ViewSession(const std::string& scene, std::vector<std::string> words);
  ~ViewSession() override;

  /// Of loading and building: input that was not taken literally.
  const std::vector<std::string>& warnings() const { return warnings_; }

  const SceneOutline* outline() const override { return &outline_; }
  std::uint64_t change(const std::string& viewer, const FlagChange& flags, const std::string& layer) override;
  ViewerStatus status(const std::string& viewer) override;
  std::string command(const std::string& viewer) override;
  void stop() override;

 private:
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

  void welcome(Viewer& made) override;
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

  RenderSettings base_;
  std::vector<std::string> warnings_;
  std::mutex renders_;  ///< held while the scene or the renderer is used
  LiveScene scene_;
  const SceneOutline outline_;
  std::optional<renderer::Renderer> renderer_;
  std::optional<renderer::ChosenOptions> chosen_;  ///< for the scene
  bool shares_cache_ = false;                      ///< the frames have begun
  renderer::EnvironmentOptions environment_;       ///< of the last picture
  bool moved_ = false;                             ///< the renderer has not seen the scene as it is
  bool new_light_ = true;                          ///< that the cache has not learned yet
  int frame_ = 0;
  double divisor_ = 4.0;

  // With the mutex of the viewers.
  std::condition_variable work_;
  std::uint64_t version_ = 0;
  std::atomic<std::uint64_t> changes_ = 0;
  std::thread thread_;
};

}  // namespace gatelight::apps
