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
  std::vector<SweepTask> tasks() const;
  /// Makes the missing cells and calls `after_run` after each run. Returns false where a signal ended it. An
  /// exception of a cell is recorded as its failure, except OutputError: other files could not be
  /// written either.
  bool run(const std::function<void()>& after_run);
  /// The cells that are done or have failed.
  SceneResults results() const;

 private:
  struct Cell {
    CellPlace place;
    nlohmann::ordered_json record;  ///< null: not made
  };
  /// A series with one seed.
  struct Run {
    std::size_t series = 0;
    std::size_t seed = 0;
    std::vector<std::size_t> missing;  ///< cells
  };
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
  std::vector<Run> missing_runs() const;
  const KnownReference& reference_of(std::size_t series) const {
    return references_.at(reference_keys_[series]);
  }

  /// Whether the cell is the second one of a pair of seeds, and its bias is measured.
  bool completes_pair(const CellPlace& place) const;
  /// The record of a cell that has all files and errors that this sweep wants.
  std::optional<nlohmann::ordered_json> read_done(const CellPlace& place) const;

  /// Null where a signal ended it or it failed.
  const renderer::Picture* reference_picture(std::size_t series);
  /// Removes cells that another run has made meanwhile.
  void take_done(Run& run);
  bool make(Run run);
  /// Renders the cells of a run; `next` counts those that are finished. Returns false where a signal ended
  /// it.
  bool render(const Run& run, const renderer::Picture& reference, std::size_t& next);
  /// Returns false where a signal ended it.
  bool finish_cell(Cell& cell, const renderer::Picture& picture, const renderer::RenderStatistics& statistics,
                   const renderer::Picture& reference, const Reference& named);
  void fail(const std::vector<std::size_t>& cells, const std::string& error);
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
  std::vector<std::string> series_errors_;  ///< why a series cannot be made; empty where it can
  std::map<std::string, KnownReference> references_;
  std::vector<std::string> reference_keys_;  ///< of each series
  std::vector<Cell> cells_;                  ///< by series, seed and point
};

}  // namespace gatelight::apps
