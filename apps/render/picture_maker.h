#pragma once
// The pictures of one call of `gatelight render`, one after the other: their signals, snapshots and files.

#include <exception>
#include <string>
#include <vector>

#include "apps/render/console.h"
#include "apps/render/run_team.h"
#include "apps/settings/render_settings.h"
#include "base/clock.h"
#include "renderer/render.h"

namespace gatelight::apps {

class PictureMaker {
 public:
  /// `bright_lights`: lights_from_watts() of the scene.
  PictureMaker(Console& console_in, const RunTeam& team_in, std::string bright_lights);

  Console& console;
  const RunTeam& team;

  /// Begins the next picture. `start`: from where its seconds count.
  void begin(const RenderSettings& settings, Clock::time_point start = Clock::now());
  renderer::Callbacks callbacks(const renderer::Renderer& renderer);
  /// Writes and reports the picture that was begun. Returns the exit code; throws where the picture ended
  /// badly, after its files are written.
  int finish(renderer::Picture picture, const renderer::RenderStatistics& statistics);

 private:
  void write(renderer::Picture picture, const renderer::RenderStatistics& statistics,
             const std::vector<std::string>& outputs);
  void warn_of_glare(const renderer::Picture& picture, const renderer::DisplayOptions& display);
  void write_snapshot(const renderer::Picture& picture, const renderer::RenderStatistics& statistics);
  void write_results(renderer::Picture picture);
  void note_failed_output(const std::exception_ptr& error, bool again);

  const std::string bright_lights_;
  RenderSettings settings_;
  Clock::time_point start_;
  bool glare_reported_ = false;
  std::exception_ptr failed_output_;  ///< the last failure of a checkpoint or cache file
};

}  // namespace gatelight::apps
