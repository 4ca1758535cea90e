#pragma once
// One call of `gatelight render`: loads the scene, makes its pictures, writes and reports them.

#include <exception>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/rank_group.h"
#include "apps/reports/run_report.h"
#include "apps/settings/render_settings.h"
#include "apps/terminal/progress.h"
#include "base/clock.h"
#include "renderer/render.h"
#include "scene/gltf.h"

namespace gatelight::apps {

class RenderRun {
 public:
  /// `group`: the ranks that make pictures together, some of `all` where there are --frame-groups.
  RenderRun(RenderSettings settings, const std::vector<std::string>& command, const RankGroup& group,
            const RankGroup& all);

  /// Returns the exit code.
  int run();

 private:
  /// With the time of a still in the middle of its shutter.
  scene::LoadOptions load_options() const;
  int render_stills(const scene::Scene& scene);
  int make_picture(renderer::Renderer& renderer);
  /// What follows a picture that is rendered. Throws where it ended badly; what is there was written.
  int end_picture(renderer::Picture picture, const renderer::RenderStatistics& statistics);

  // Frames of an animation (render_frames.cpp).
  int render_frames(scene::SceneFile& file, scene::Scene& scene);
  /// The frames of one camera, which whole_ has.
  int render_film(scene::SceneFile& file, scene::Scene& scene);
  /// With --skip-existing: the frames whose files are there.
  std::set<int> existing_frames(const std::vector<int>& frames);
  void make_folders(int frame) const;
  /// The file from which the frames go on, --checkpoint or --cache-in, empty for none. Takes its exposure.
  std::string state_before();
  /// The renderer for all frames. Measures their exposure where none was given.
  renderer::Renderer make_renderer(scene::SceneFile& file, scene::Scene& scene);
  /// Says that frames of a part of the film differ from those of a run of all, where they do.
  void note_part(const scene::Scene& scene, const std::vector<int>& frames, const std::set<int>& existing);
  void show_frame(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer, int frame);
  /// Shows the renderer where all was and will be, for the layers of motion.
  void show_places(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer, int frame);
  /// Makes the cache, or reads it from `before`. Returns the last frame that is done, where the run is
  /// resumed.
  std::optional<int> begin_frames(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                                  const std::string& before);
  /// Takes cache and light of `before`.
  std::optional<int> go_on(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                           const std::string& before);
  /// Writes --checkpoint and --cache-out.
  void write_state(const renderer::Renderer& renderer, int frame);
  /// The number of a signal that ended it, or 0.
  int make_frame(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer, int frame);
  int stop_frames(int signal, std::size_t done, std::size_t count);
  /// After the frames of each group: reports those of all. Returns the exit code.
  int end_groups(int signal, std::size_t done, std::size_t count, double seconds);
  void end_frames(std::size_t count, double seconds);
  /// Keeps a failure of one frame, so that the others are rendered.
  void note_failed_frame(int frame);

  /// Sets the chosen integrator in the settings, which the reports show.
  void note_integrator(renderer::Integrator chosen);
  void note_loaded(const scene::Scene& scene);
  renderer::Callbacks make_callbacks(const renderer::Renderer& renderer);
  /// Tries all outputs before it throws the first error, so that a full disk does not cost the other picture.
  void write_pictures(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                      const std::vector<std::string>& outputs);
  void warn_of_glare(const renderer::Picture& picture, const renderer::DisplayOptions& display,
                     float suitable);
  void write_snapshot(const renderer::Picture& picture, const renderer::RenderStatistics& statistics);
  void write_results(renderer::Picture picture);
  void print_results();
  /// Prints a line; with --progress json as an event.
  void note(const char* about, const std::string& text);
  /// How many pictures --skip-existing has left out.
  void note_skipped(std::size_t skipped, std::size_t count);
  void note_failed_output(const std::exception_ptr& error, bool again);
  /// The signal that some rank received; 0: none.
  int signal() const;
  /// A signal before the first pass: there is nothing to write.
  int stop_without_picture(int signal);
  /// Prints what was not printed before, and adds it to the report of the picture.
  void warn(const std::string& text);

  RenderSettings settings_;  ///< of the picture that is made
  RenderSettings whole_;     ///< of all pictures
  const RankGroup group_;
  const RankGroup& all_;
  RunReport report_;
  Clock::time_point start_ = Clock::now();
  ProgressReporter progress_;
  std::set<std::string> printed_warnings_;
  std::string bright_lights_;  ///< lights_from_watts()
  bool glare_reported_ = false;
  std::exception_ptr failed_output_;  ///< the last failure of a checkpoint or cache file
  std::exception_ptr failed_frame_;   ///< the first one
  std::optional<int> shown_frame_;    ///< by the renderer
  int last_frame_ = 0;                ///< to be rendered
};

}  // namespace gatelight::apps
