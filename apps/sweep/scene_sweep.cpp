#include "apps/sweep/scene_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/job/finished_picture.h"
#include "apps/reports/recipe.h"
#include "apps/sweep/gate_memory.h"
#include "apps/sweep/identity.h"
#include "apps/sweep/planned.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/text.h"
#include "renderer/image/image_write.h"
#include "renderer/render.h"
#include "renderer/settings/resolved_options.h"
#include "scene/gltf.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using renderer::Picture;
using renderer::RenderStatistics;

/// Why the work fails, in a line; empty where it does not. Where an output cannot be written, others could
/// not be written either, so that ends the sweep.
template <class Work>
std::string why_failed(const Work& work) {
  try {
    work();
  } catch (const OutputError&) {
    throw;
  } catch (...) {
    return one_line(describe_current_exception().message);
  }
  return "";
}

}  // namespace

std::vector<int> SceneSweep::points_in(const Run& run) {
  std::vector<int> points;
  for (const Cell* cell : run) points.push_back(cell->place.point);
  return points;
}

SceneSweep::SceneSweep(const PlannedScene& planned, const SweepPlan& plan, const SweepSettings& settings,
                       SweepProgress& progress)
    : planned_(planned),
      plan_(plan),
      settings_(settings),
      progress_(progress),
      series_(planned.series),
      series_errors_(planned.series.size()) {}

bool SceneSweep::open() {
  const auto read = [&] {
    load();
    is_open_ = decide_memory();
    if (is_open_) name_cells();
  };
  if (plan_.scenes.size() == 1) {
    read();
  } else if (const std::string error = why_failed(read); !error.empty()) {
    fail_all(error);
  }
  return stop_signal() == 0;
}

void SceneSweep::close() {
  is_open_ = false;
  scene_ = {};
  fingerprints_.clear();
  for (auto& [key, known] : references_) known.picture.reset();
}

void SceneSweep::load() {
  progress_.phase(fmt::format("load {}", planned_.name));
  series_ = planned_.series;
  scene_ = scene::load_gltf(planned_.file, series_.front().settings.load);
}

void SceneSweep::fail_all(const std::string& error) {
  close();
  references_.clear();
  cells_.clear();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    for (const std::uint32_t seed : plan_.seeds) {
      for (const int point : series_[i].points) {
        // Without a scene there is no fingerprint; no other cell has such a name.
        const CellPlace place{
            planned_, series_[i], seed, point, fmt::format("{}-{}-{}-{}", planned_.name, i, seed, point), ""};
        cells_.push_back({place, error, failed_record(place, error)});
      }
    }
  }
  warn(fmt::format("{}: all of its cells failed: {}", planned_.name, error));
}

const renderer::SceneFingerprint& SceneSweep::fingerprint_of(const RenderSettings& settings) {
  const renderer::EnvironmentOptions& e = settings.render.environment;
  const std::string key =
      fmt::format("{} {},{},{} {} {} {}", e.file, e.constant.x(), e.constant.y(), e.constant.z(),
                  e.rotation_degrees, e.scale, e.sky ? renderer::text_of(*e.sky) : "");
  const auto found = fingerprints_.find(key);
  if (found != fingerprints_.end()) return found->second;
  return fingerprints_.emplace(key, renderer::compute_scene_fingerprint(scene_, e)).first->second;
}

bool SceneSweep::decide_memory() {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    PlannedSeries& series = series_[i];
    if (!series.memory) continue;
    // Building and scouting cannot be interrupted.
    if (stop_signal() != 0) return false;
    progress_.phase(fmt::format("memory of {}", series.label));
    series_errors_[i] = why_failed([&] {
      const RenderSettings& gate = series.memory->settings;
      const std::string key =
          identity_name(fingerprint_of(gate), {"memory", deciding_text(gate, view_of(scene_, gate.render))});
      const std::uint64_t bytes = gate_memory(in_folder("gate-memory.json"), key, scene_, gate.render);
      const auto wanted =
          static_cast<std::uint64_t>(std::max(1.0, static_cast<double>(bytes) / series.memory->divisor));
      series.settings.render.cache.memory_bytes = wanted;
      // With all digits, so that the command gives the same bytes.
      set_flag(series.flags, "--cache-memory", fmt::format("{}", static_cast<double>(wanted) / 1048576.0));
    });
  }
  return true;
}

Reference SceneSweep::planned_reference(const PlannedSeries& series) {
  return plan_reference(series.settings, series.reference, scene_, fingerprint_of(series.settings),
                        settings_.reference_spp, settings_.reference_folder);
}

/// One picture can only be the reference of one view and light.
std::optional<Reference> SceneSweep::find_given() {
  if (settings_.reference_files.empty()) return std::nullopt;
  std::set<std::string> wanted;
  for (const PlannedSeries& series : series_) wanted.insert(planned_reference(series).key);
  if (wanted.size() > 1) {
    throw BadOption({"reference", settings_.reference_files.front(),
                     fmt::format("is one picture, but the cells need {} different ones", wanted.size()),
                     "`reference-spp`"});
  }
  const PlannedSeries& any = series_.front();
  return given_reference(any.reference, settings_.reference_files, any.settings.render);
}

void SceneSweep::name_cells() {
  const std::optional<Reference> given = find_given();
  references_.clear();
  cells_.clear();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const PlannedSeries& series = series_[i];
    const renderer::SceneFingerprint& fingerprint = fingerprint_of(series.settings);
    const renderer::View view = view_of(scene_, series.settings.render);
    const std::string machine = machine_text(series.settings.render);
    Reference reference = given ? *given : planned_reference(series);
    read_reference_numbers(reference);
    references_.emplace(reference.key, KnownReference{reference, {}, {}});
    for (const std::uint32_t seed : plan_.seeds) {
      for (const int point : series.points) {
        const RenderSettings settings = cell_settings(series, planned_.file, seed, point);
        // The memory of a series that failed is unknown, so its label makes the names unique.
        const std::string deciding = deciding_text(settings, view) + named_text(series) +
                                     (series_errors_[i].empty() ? "" : series.label);
        const std::string id =
            identity_name(fingerprint, {deciding, reference.key, machine, settings_.hdr_flip ? "hdr" : ""});
        cells_.push_back({{planned_, series, seed, point, id, reference.key}, series_errors_[i], nullptr});
        take_done(cells_.back());
      }
    }
  }
}

bool SceneSweep::completes_pair(const CellPlace& place) const {
  const bool second = (place.seed - plan_.seeds.front()) % 2 == 1;
  return settings_.keep_exr && second && references_.at(place.reference_key).reference.halves.size() == 2;
}

bool SceneSweep::take_done(Cell& cell) const {
  const CellPlace& place = cell.place;
  auto record = read_done_record(settings_.folder, place, wants_pictures(place));
  if (!record) return false;
  const bool has_bias = (*record)["errors"].value("bias_rel_mse", nlohmann::ordered_json()).is_number();
  const bool lacks_bias = completes_pair(place) && !has_bias;
  if (settings_.keep_exr && (lacks_bias || !fs::exists(in_folder(exr_file(place.id))))) return false;
  cell.record = std::move(*record);
  return true;
}

std::vector<SceneSweep::Run> SceneSweep::missing_runs() {
  std::vector<Run> runs;
  // A scene that could not be read has no references, and its cells stay failed.
  if (references_.empty()) return runs;
  const auto same_run = [](const CellPlace& a, const CellPlace& b) {
    return &a.series == &b.series && a.seed == b.seed;
  };
  for (Cell& cell : cells_) {
    if (is_done(cell.record)) continue;
    if (runs.empty() || !same_run(runs.back().front()->place, cell.place)) runs.emplace_back();
    runs.back().push_back(&cell);
  }
  // The first seed of all series comes first, so that a sweep that is stopped early has something of each.
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.front()->place.seed < b.front()->place.seed; });
  return runs;
}

std::vector<SweepTask> SceneSweep::tasks() {
  std::vector<SweepTask> tasks;
  std::set<std::string> referred;
  for (const Run& run : missing_runs()) {
    const auto& [scene, series, seed, point, id, key] = run.front()->place;
    if (!references_.at(key).reference.is_made() && referred.insert(key).second)
      tasks.push_back(reference_task(series.settings.render, series.reference, settings_.reference_spp));
    tasks.push_back(run_task(series, points_in(run)));
  }
  return tasks;
}

bool SceneSweep::run(const std::function<void()>& after_run) {
  for (const std::string& warning : scene_.warnings) warn(warning);
  for (Run& run : missing_runs()) {
    if (stop_signal() != 0) return false;
    const bool finished = make(std::move(run));
    after_run();
    if (!finished) return false;
  }
  return true;
}

const Picture* SceneSweep::reference_picture(const CellPlace& place) {
  KnownReference& known = references_.at(place.reference_key);
  if (known.picture) return &*known.picture;
  if (!known.error.empty()) return nullptr;
  const bool made = known.reference.is_made();
  const std::string kind = renderer::name_of(kReferenceKinds, known.reference.kind);
  if (!made) progress_.begin(fmt::format("{} reference {}", planned_.name, kind), true);
  const std::string failure = why_failed(
      [&] { known.picture = make_reference(known.reference, scene_, place.series.settings, callbacks()); });
  if (!failure.empty()) known.error = fmt::format("the reference could not be made: {}", failure);
  const bool stopped = !known.picture && failure.empty();
  if (!made && !stopped) progress_.end();
  return known.picture ? &*known.picture : nullptr;
}

bool SceneSweep::make(Run run) {
  const CellPlace& place = run.front()->place;
  std::string error = run.front()->error;
  const Picture* reference = error.empty() ? reference_picture(place) : nullptr;
  if (!reference && stop_signal() != 0) return false;

  progress_.begin(fmt::format("{}  {}  seed {}", planned_.name, place.series.label, place.seed), false);
  // Two series can turn out to have the same memory, and so the same cells.
  std::erase_if(run, [&](Cell* cell) { return take_done(*cell); });
  std::size_t next = 0;
  bool finished = true;
  if (!reference && error.empty()) error = references_.at(place.reference_key).error;
  if (reference && !run.empty()) error = why_failed([&] { finished = render(run, *reference, next); });
  if (!error.empty()) fail({run.begin() + static_cast<std::ptrdiff_t>(next), run.end()}, error);
  if (finished) progress_.end();
  return finished;
}

bool SceneSweep::render(const Run& run, const Picture& reference, std::size_t& next) {
  const CellPlace& place = run.front()->place;
  PlannedSeries& series = series_[static_cast<std::size_t>(&place.series - series_.data())];
  const std::vector<int> points = points_in(run);
  const RenderSettings settings = cell_settings(series, planned_.file, place.seed, points.back());
  if (settings_.verbose) {
    progress_.clear();
    log_detail(fmt::format("options: {}", dump_options(settings)));
  }
  progress_.phase("build");
  renderer::Renderer renderer(scene_, settings.render);
  const auto finish = [&](int point, const Picture& picture, const RenderStatistics& statistics) {
    const auto index = static_cast<std::size_t>(point);
    if (finish_cell(*run[index], picture, statistics, reference)) next = index + 1;
  };
  if (series.named) {
    // The choice depends on the view only, so all seeds have the same one.
    renderer::use_chosen(series.settings.render, renderer.chosen());
    const Picture picture = renderer.render(callbacks());
    const RenderStatistics& statistics = renderer.statistics();
    require_good_end(statistics, false);
    if (!statistics.interrupted) finish(0, picture, statistics);
  } else {
    renderer.render_series(series.has_cache() ? renderer::Series{points, {}} : renderer::Series{{}, points},
                           finish, callbacks());
  }
  return next == run.size();
}

bool SceneSweep::finish_cell(Cell& cell, const Picture& picture, const RenderStatistics& statistics,
                             const Picture& reference) {
  const CellPlace& place = cell.place;
  const Reference& named = references_.at(place.reference_key).reference;
  const RenderSettings& settings = place.series.settings;
  // Occlusion lies between 0 and 1, so it needs no exposures.
  const bool hdr = settings_.hdr_flip && place.series.reference != ReferenceKind::ao;
  if (!statistics.denoise_failure.empty() && stop_signal() == 0)
    throw MissingDenoiser(statistics.denoise_failure);
  progress_.phase("measure");
  const auto go_on = [this](double fraction) {
    progress_.phase("measure", fraction);
    return stop_signal() == 0;
  };
  const renderer::NamedPicture true_light{reference, named.file}, test{picture, cell_file(place.id)};
  CompareReport errors{.metrics = {Metric::ssim, Metric::flip},
                       .errors = renderer::compare_pictures(true_light, test),
                       .flip_options = {.exposure = settings.image.display.exposure,
                                        .tonemap = settings.image.display.tonemap}};
  if (hdr) errors.metrics.push_back(Metric::hdr_flip);
  if (named.rel_mse_noise) errors.rel_mse_clean = errors.errors.rel_mse - *named.rel_mse_noise;
  const bool finite = errors.errors.nonfinite_reference + errors.errors.nonfinite_test == 0;
  if (finite && !measure_looks(errors, true_light, test, false, go_on)) return false;
  if (settings_.keep_exr) renderer::write_image(picture, in_folder(exr_file(place.id)), {.exr_float = true});
  const Cell* first = completes_pair(place) ? &cell - place.series.points.size() : nullptr;
  if (first && is_done(first->record)) {
    errors.bias_rel_mse = measure_bias(named, in_folder(exr_file(first->place.id)), test);
  }
  const bool pictures = wants_pictures(place);
  if (pictures) {
    renderer::write_image(picture, in_folder(picture_file(place.id)), settings.image);
    if (errors.flip) {
      renderer::write_image(renderer::flip_map(*errors.flip), in_folder(error_map_file(place.id)));
    }
  }
  cell.record = done_record(place, statistics, errors, pictures,
                            renderer::resolve_ao_distance(settings.render.ao_distance, scene_.bounds));
  keep(cell);
  return true;
}

void SceneSweep::fail(const Run& run, const std::string& error) {
  if (run.empty()) return;
  for (Cell* cell : run) {
    cell->record = failed_record(cell->place, error);
    keep(*cell);
  }
  const CellPlace& first = run.front()->place;
  warn(fmt::format("{}, {}, seed {}: {} cell{} failed: {}", planned_.name, first.series.label, first.seed,
                   run.size(), run.size() == 1 ? "" : "s", error));
}

void SceneSweep::keep(Cell& cell) const {
  write_file_atomically(in_folder(cell_file(cell.place.id)), json_text(cell.record) + "\n");
  progress_.cell(cell.place.id, cell.record["status"].get<std::string>());
}

SceneResults SceneSweep::results() const {
  SceneResults results;
  results.scene = {{"name", planned_.name}, {"file", planned_.file}};
  results.scene["references"] = nlohmann::ordered_json::array();
  for (const auto& [key, known] : references_)
    results.scene["references"].push_back(reference_json(known.reference, settings_.folder));
  for (const Cell& cell : cells_) {
    if (!cell.record.is_null()) results.cells.push_back(cell.record);
  }
  return results;
}

renderer::Callbacks SceneSweep::callbacks() {
  return {.progress = [this](const renderer::Progress& progress) { progress_.update(progress); },
          .stop = [] { return stop_signal() != 0; },
          .snapshot_wanted = {},
          .snapshot = {}};
}

void SceneSweep::warn(const std::string& text) {
  progress_.clear();
  log_warning(text);
}

std::string SceneSweep::in_folder(const std::string& file) const {
  return (fs::path(settings_.folder) / file).string();
}

}  // namespace gatelight::apps
