#pragma once
// The cells of one scene: read where they are done, else made.

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/cell_record.h"
#include "apps/sweep/references.h"
#include "apps/sweep/request.h"
#include "apps/sweep/results.h"
#include "apps/sweep/sweep_progress.h"

namespace gatelight::apps {

class SceneSweep {
 public:
  SceneSweep(const PlannedScene& planned, const SweepPlan& plan, const SweepSettings& settings,
             SweepProgress& progress);
  SceneSweep(const SceneSweep&) = delete;
  SceneSweep& operator=(const SceneSweep&) = delete;

  /// Loads the scene, names its cells and reads those that are done. Returns false where a signal ended it.
  /// Where the scene cannot be read or a --reference does not fit, all its cells fail; the only scene of a
  /// plan throws that instead.
  bool open();
  bool is_open() const { return is_open_; }
  /// Frees the memory of the scene. Results and tasks stay.
  void close();
  /// The tasks of missing cells; empty where all cells are done.
  std::vector<SweepTask> tasks();
  /// Makes the missing cells and calls `after_run` after each run. Returns false where a signal ended it. An
  /// exception of a cell is recorded as its failure, except OutputError: other files could not be
  /// written either.
  bool run(const std::function<void()>& after_run);
  /// The cells that are done or have failed.
  SceneResults results() const;

 private:
  struct Cell {
    CellPlace place;
    std::string error;              ///< why its series cannot be made; empty where it can
    nlohmann::ordered_json record;  ///< null: not made
  };
  /// Cells of a series with one seed, at least one.
  using Run = std::vector<Cell*>;
  struct KnownReference {
    Reference reference;
    std::optional<renderer::Picture> picture;
    std::string error;  ///< why it cannot be made
  };

  void load();
  void fail_all(const std::string& error);
  const renderer::SceneFingerprint& fingerprint_of(const RenderSettings& settings);
  bool decide_memory();
  std::optional<Reference> find_given();
  void name_cells();
  Reference planned_reference(const PlannedSeries& series);
  std::vector<Run> missing_runs();
  static std::vector<int> points_in(const Run& run);

  /// Whether the cell is the second one of a pair of seeds, and its bias is measured.
  bool completes_pair(const CellPlace& place) const;
  /// Reads the record of a cell that is done. Returns false where there is none, or it lacks files or errors
  /// that this sweep wants.
  bool take_done(Cell& cell) const;

  /// Null where a signal ended it or it failed.
  const renderer::Picture* reference_picture(const CellPlace& place);
  bool make(Run run);
  /// Renders the cells of a run; `next` counts those that are finished. Returns false where a signal ended
  /// it.
  bool render(const Run& run, const renderer::Picture& reference, std::size_t& next);
  /// Returns false where a signal ended it.
  bool finish_cell(Cell& cell, const renderer::Picture& picture, const renderer::RenderStatistics& statistics,
                   const renderer::Picture& reference);
  void fail(const Run& run, const std::string& error);
  void keep(Cell& cell) const;
  bool wants_pictures(const CellPlace& place) const { return place.seed == plan_.seeds.front(); }
  renderer::Callbacks callbacks();
  void warn(const std::string& text);
  std::string in_folder(const std::string& file) const;

  const PlannedScene& planned_;
  const SweepPlan& plan_;
  const SweepSettings& settings_;
  SweepProgress& progress_;
  bool is_open_ = false;
  scene::Scene scene_;
  std::map<std::string, renderer::SceneFingerprint> fingerprints_;  ///< by environment
  std::vector<PlannedSeries> series_;                               ///< with resolved memory
  std::vector<std::string> series_errors_;            ///< why a series cannot be made; empty where it can
  std::map<std::string, KnownReference> references_;  ///< by key
  std::vector<Cell> cells_;                           ///< by series, seed and point
};

}  // namespace gatelight::apps
