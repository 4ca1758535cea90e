#include "apps/sweep/scene_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/job/finished_picture.h"
#include "apps/reports/recipe.h"
#include "apps/sweep/eta.h"
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
  reference_keys_.clear();
  references_.clear();
  cells_.clear();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    for (const std::uint32_t seed : plan_.seeds) {
      for (const int point : series_[i].points) {
        // Without a scene there is no fingerprint; no other cell has such a name.
        const CellPlace place{
            planned_, series_[i], seed, point, fmt::format("{}-{}-{}-{}", planned_.name, i, seed, point), ""};
        cells_.push_back({place, failed_record(place, error)});
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
  reference_keys_.clear();
  cells_.clear();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const PlannedSeries& series = series_[i];
    const renderer::SceneFingerprint& fingerprint = fingerprint_of(series.settings);
    const renderer::View view = view_of(scene_, series.settings.render);
    const std::string machine = machine_text(series.settings.render);
    Reference reference = given ? *given : planned_reference(series);
    read_reference_numbers(reference);
    reference_keys_.push_back(reference.key);
    references_.emplace(reference.key, KnownReference{reference, {}, {}});
    for (const std::uint32_t seed : plan_.seeds) {
      for (const int point : series.points) {
        const RenderSettings settings = cell_settings(series, planned_.file, seed, point);
        // The memory of a series that failed is unknown, so its label makes the names unique.
        const std::string deciding = deciding_text(settings, view) + named_text(series) +
                                     (series_errors_[i].empty() ? "" : series.label);
        Cell cell{.place = {planned_, series, seed, point,
                            identity_name(fingerprint, {deciding, reference.key, machine,
                                                        settings_.hdr_flip ? "hdr" : ""}),
                            reference.key},
                  .record = nullptr};
        if (auto record = read_done(cell.place)) cell.record = std::move(*record);
        cells_.push_back(std::move(cell));
      }
    }
  }
}

bool SceneSweep::completes_pair(const CellPlace& place) const {
  const bool second = (place.seed - plan_.seeds.front()) % 2 == 1;
  return settings_.keep_exr && second && references_.at(place.reference_key).reference.halves.size() == 2;
}

std::optional<nlohmann::ordered_json> SceneSweep::read_done(const CellPlace& place) const {
  auto record = read_done_record(settings_.folder, place, wants_pictures(place));
  if (!record || !settings_.keep_exr) return record;
  const bool whole = fs::exists(in_folder(exr_file(place.id))) &&
                     (!completes_pair(place) ||
                      (*record)["errors"].value("bias_rel_mse", nlohmann::ordered_json()).is_number());
  return whole ? record : std::nullopt;
}

std::vector<SceneSweep::Run> SceneSweep::missing_runs() const {
  std::vector<Run> runs;
  // A scene that could not be read has none.
  if (references_.empty()) return runs;
  std::size_t cell = 0;
  for (std::size_t series = 0; series < series_.size(); ++series) {
    for (std::size_t seed = 0; seed < plan_.seeds.size(); ++seed) {
      Run run{series, seed, {}};
      for (std::size_t point = 0; point < series_[series].points.size(); ++point, ++cell) {
        if (!is_done(cells_[cell].record)) run.missing.push_back(cell);
      }
      if (!run.missing.empty()) runs.push_back(std::move(run));
    }
  }
  // The first seed of all series comes first, so that a sweep that is stopped early has something of each.
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.seed < b.seed; });
  return runs;
}

std::vector<SweepTask> SceneSweep::tasks() const {
  std::vector<SweepTask> tasks;
  std::set<std::string> referred;
  for (const Run& run : missing_runs()) {
    const PlannedSeries& series = series_[run.series];
    const Reference& reference = reference_of(run.series).reference;
    if (!reference.is_made() && referred.insert(reference.key).second)
      tasks.push_back(reference_task(series.settings.render, series.reference, settings_.reference_spp));
    std::vector<int> points;
    for (const std::size_t cell : run.missing) points.push_back(cells_[cell].place.point);
    tasks.push_back(run_task(series, points));
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

const Picture* SceneSweep::reference_picture(std::size_t series) {
  KnownReference& known = references_.at(reference_keys_[series]);
  if (known.picture) return &*known.picture;
  if (!known.error.empty()) return nullptr;
  const bool made = known.reference.is_made();
  const std::string kind = renderer::name_of(kReferenceKinds, known.reference.kind);
  if (!made) progress_.begin(fmt::format("{} reference {}", planned_.name, kind), true);
  const std::string failure = why_failed([&] {
    known.picture = make_reference(known.reference, scene_, series_[series].settings, callbacks());
  });
  if (!failure.empty()) known.error = fmt::format("the reference could not be made: {}", failure);
  const bool stopped = !known.picture && failure.empty();
  if (!made && !stopped) progress_.end();
  return known.picture ? &*known.picture : nullptr;
}

void SceneSweep::take_done(Run& run) {
  std::erase_if(run.missing, [&](std::size_t index) {
    Cell& cell = cells_[index];
    auto record = read_done(cell.place);
    if (record) cell.record = std::move(*record);
    return record.has_value();
  });
}

bool SceneSweep::make(Run run) {
  const PlannedSeries& series = series_[run.series];
  std::string error = series_errors_[run.series];
  const Picture* reference = error.empty() ? reference_picture(run.series) : nullptr;
  if (!reference && stop_signal() != 0) return false;

  progress_.begin(fmt::format("{}  {}  seed {}", planned_.name, series.label, plan_.seeds[run.seed]), false);
  // Two series can turn out to have the same memory, and so the same cells.
  take_done(run);
  std::size_t next = 0;  // index into run.missing
  bool finished = true;
  if (!reference && error.empty()) error = reference_of(run.series).error;
  if (reference && !run.missing.empty())
    error = why_failed([&] { finished = render(run, *reference, next); });
  if (!error.empty())
    fail({run.missing.begin() + static_cast<std::ptrdiff_t>(next), run.missing.end()}, error);
  if (finished) progress_.end();
  return finished;
}

bool SceneSweep::render(const Run& run, const Picture& reference, std::size_t& next) {
  PlannedSeries& series = series_[run.series];
  std::vector<int> points;
  for (const std::size_t cell : run.missing) points.push_back(cells_[cell].place.point);
  const RenderSettings settings = cell_settings(series, planned_.file, plan_.seeds[run.seed], points.back());
  if (settings_.verbose) {
    progress_.clear();
    log_detail(fmt::format("options: {}", dump_options(settings)));
  }
  progress_.phase("build");
  renderer::Renderer renderer(scene_, settings.render);
  const auto finish = [&](int point, const Picture& picture, const RenderStatistics& statistics) {
    const auto index = static_cast<std::size_t>(point);
    Cell& cell = cells_[run.missing[index]];
    if (finish_cell(cell, picture, statistics, reference, reference_of(run.series).reference))
      next = index + 1;
  };
  if (series.named) {
    // The choice depends on the view only, so all seeds have the same one.
    if (settings.render.choose_integrator)
      renderer::use_integrator(series.settings.render, renderer.integrator());
    const Picture picture = renderer.render(callbacks());
    const RenderStatistics& statistics = renderer.statistics();
    require_good_end(statistics, false);
    if (!statistics.interrupted) finish(0, picture, statistics);
  } else {
    renderer.render_series(series.has_cache() ? renderer::Series{points, {}} : renderer::Series{{}, points},
                           finish, callbacks());
  }
  return next == run.missing.size();
}

bool SceneSweep::finish_cell(Cell& cell, const Picture& picture, const RenderStatistics& statistics,
                             const Picture& reference, const Reference& named) {
  const CellPlace& place = cell.place;
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
  std::optional<CellErrors> measured =
      measure_errors({reference, named.file}, named.rel_mse_noise, {picture, cell_file(place.id)},
                     settings.image, hdr, go_on);
  if (!measured) return false;
  CellErrors& errors = *measured;
  if (settings_.keep_exr) renderer::write_image(picture, in_folder(exr_file(place.id)), {.exr_float = true});
  const Cell* first = completes_pair(place) ? &cell - place.series.points.size() : nullptr;
  if (first && is_done(first->record)) {
    errors.bias_rel_mse =
        measure_bias(named, in_folder(exr_file(first->place.id)), {picture, cell_file(place.id)});
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

void SceneSweep::fail(const std::vector<std::size_t>& cells, const std::string& error) {
  if (cells.empty()) return;
  for (const std::size_t index : cells) {
    Cell& cell = cells_[index];
    cell.record = failed_record(cell.place, error);
    keep(cell);
  }
  const CellPlace& first = cells_[cells.front()].place;
  warn(fmt::format("{}, {}, seed {}: {} cell{} failed: {}", planned_.name, first.series.label, first.seed,
                   cells.size(), cells.size() == 1 ? "" : "s", error));
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
