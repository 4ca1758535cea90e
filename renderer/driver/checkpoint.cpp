#include "renderer/driver/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/file/content_digest.h"
#include "base/to_number.h"
#include "renderer/cache/cache_content.h"
#include "renderer/film/film_samples.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kFormat = "gatelight-checkpoint";
constexpr int kVersion = 11;
constexpr const char* kOptions = "option";
constexpr const char* kStatistics = "statistics";
constexpr const char* kPhase = "phase";
constexpr const char* kSamples = "samples";
constexpr const char* kFirstStep = "first_step";
constexpr const char* kTaught = "taught";
constexpr const char* kHasCache = "cache";
constexpr const char* kNonFinite = "nonfinite_samples";
constexpr const char* kGuard = "training_guard";

/// Visits the members that add up over the runs of a picture: the same one of each of the statistics.
template <class Visit, class... Statistics>
void each_sum(Visit&& visit, Statistics&... s) {
  visit("render-seconds", s.render_seconds...);
  visit("camera-rays", s.rays.camera...);
  visit("bounce-rays", s.rays.bounce...);
  visit("shadow-rays", s.rays.shadow...);
  visit("trace-seconds", s.rays.seconds...);
  visit("nonfinite", s.nonfinite...);
  visit("clamped", s.clamped...);
  visit("cache-steps", s.cache.steps...);
  visit("cache-records", s.cache.records...);
  visit("cache-rejected", s.cache.rejected...);
  visit("cache-unstored", s.cache.unstored...);
  visit("cache-training-paths", s.cache.training_paths...);
  visit("cache-scout-seconds", s.cache.scout_seconds...);
  visit("cache-setup-seconds", s.cache.setup_seconds...);
  visit("cache-train-seconds", s.cache.train_seconds...);
  visit("cache-train-trace-seconds", s.cache.train_trace_seconds...);
  visit("cache-train-query-seconds", s.cache.train_query_seconds...);
  visit("cache-train-step-seconds", s.cache.train_step_seconds...);
  visit("cache-render-trace-seconds", s.cache.render_trace_seconds...);
  visit("cache-render-query-seconds", s.cache.render_query_seconds...);
  visit("cache-queries", s.cache.queries...);
  visit("cache-negative-answers", s.cache.negative_answers...);
  visit("cache-unstored-hits", s.cache.unstored_hits...);
}

/// Visits the members that only the last run with training determines.
template <class Visit, class... Statistics>
void each_last(Visit&& visit, Statistics&... s) {
  visit("cache-touched-nodes", s.cache.touched_nodes...);
  visit("cache-loss", s.cache.loss...);
}

/// The planes of a film are tensors of words, and their names.
std::string plane_name(const char* plane) {
  return fmt::format("film.{}", plane);
}

/// Number of words of a plane's tensor.
template <class Plane>
std::uint64_t words_of(const Plane& plane) {
  static_assert(sizeof(plane[0]) % sizeof(std::uint32_t) == 0);
  return plane.size() * (sizeof(plane[0]) / sizeof(std::uint32_t));
}

bool all_finite(std::span<const double> sums) {
  return std::all_of(sums.begin(), sums.end(), [](double x) { return std::isfinite(x); });
}
bool is_finite(const RadianceSum& s) {
  return all_finite(s.sum) && all_finite(s.square);
}
bool is_finite(const HalfSum& s) {
  return all_finite(s.sum);
}
bool is_finite(const std::array<double, 3>& s) {
  return all_finite(s);
}
// The other planes may hold any value: only layers and guides read them.
bool is_finite(const GuideSum&) {
  return true;
}
bool is_finite(double) {
  return true;
}
bool is_finite(const FirstHitSum&) {
  return true;
}

const char* phase_name(Phase phase) {
  return phase == Phase::train ? "train" : "render";
}

const std::string& text_at(const SafetensorsReader& file, const std::string& key) {
  const auto found = file.metadata().find(key);
  if (found == file.metadata().end()) file.fail(fmt::format("metadata '{}' is missing", key));
  return found->second;
}

template <class Number>
Number number_at(const SafetensorsReader& file, const std::string& key) {
  const std::string& text = text_at(file, key);
  const std::optional<Number> value = to_number<Number>(text);
  if (!value || !(*value >= Number{0}))
    file.fail(fmt::format("{}: '{}', expected a number, not negative", key, text));
  return *value;
}

using GuardValues = std::array<double, 7>;

GuardValues to_values(const TrainingGuard& guard) {
  // Counts are far below 2^53.
  return {guard.loss_average,
          guard.loss_least,
          static_cast<double>(guard.steps),
          guard.group_loss,
          static_cast<double>(guard.group_steps),
          guard.brightest,
          static_cast<double>(guard.good_steps)};
}

TrainingGuard read_guard(SafetensorsReader& file, std::uint64_t steps) {
  GuardValues values{};
  read_array(file, kGuard, TensorType::f64, values);
  const auto refuse = [&](std::size_t i, const std::string& expected) {
    file.fail(fmt::format("tensor '{}': element {} is {}, expected {}", kGuard, i, values[i], expected));
  };
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isnan(values[i])) refuse(i, "a number");
  for (const std::size_t i : {2u, 4u, 6u})
    if (!(values[i] >= 0.0 && values[i] <= static_cast<double>(steps)))
      refuse(i, fmt::format("0 to the {} steps of the training", steps));
  const auto count = [&](std::size_t i) { return static_cast<std::uint64_t>(values[i]); };
  return {values[0], values[1], count(2), values[3], count(4), values[5], count(6)};
}

/// A sample is four words in the file.
constexpr std::size_t kSampleWords = sizeof(NonFiniteSample) / sizeof(std::uint32_t);

std::vector<NonFiniteSample> read_nonfinite(SafetensorsReader& file) {
  const std::uint64_t words = file.length(kNonFinite, TensorType::u32);
  if (words % kSampleWords != 0)
    file.fail(fmt::format("tensor '{}': {} numbers, expected four a sample", kNonFinite, words));
  std::vector<NonFiniteSample> samples(words / kSampleWords);
  file.read(kNonFinite, TensorType::u32, {{words}}, std::as_writable_bytes(std::span(samples)));
  return samples;
}

std::set<std::string> own_tensors() {
  std::set<std::string> names = {kNonFinite, kGuard};
  const FilmSums none;
  FilmSums::each_plane(none, [&](const char* name, const auto&) { names.insert(plane_name(name)); });
  return names;
}

}  // namespace

void add_earlier(RenderStatistics& statistics, const RenderStatistics& earlier) {
  if (statistics.cache.steps == 0)
    each_last([](const char*, auto& value, const auto& before) { value = before; }, statistics, earlier);
  each_sum([](const char*, auto& value, const auto& before) { value += before; }, statistics, earlier);
  statistics.nonfinite_samples.insert(statistics.nonfinite_samples.end(), earlier.nonfinite_samples.begin(),
                                      earlier.nonfinite_samples.end());
  keep_first(statistics.nonfinite_samples);
}

void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const CheckpointProgress& progress, const RenderStatistics& statistics,
                      const Film& film, const std::optional<CheckpointCache>& cache) {
  CacheContent content;
  if (cache) fill_cache_content(content, cache->model, cache->options, cache->state);
  std::vector<TensorView> tensors = content.tensors;
  const FilmSums none;
  const FilmSums& sums = progress.samples > 0 || progress.has_training_samples ? film.sums() : none;
  FilmSums::each_plane(sums, [&](const char* name, const auto& plane) {
    tensors.push_back(
        {plane_name(name), TensorType::u32, {words_of(plane)}, std::as_bytes(std::span(plane))});
  });
  GuardValues guard{};
  if (cache) {
    guard = to_values(cache->state.guard);
    tensors.push_back(view_array(kGuard, TensorType::f64, guard));
  }
  const std::span nonfinite(statistics.nonfinite_samples);
  tensors.push_back(
      {kNonFinite, TensorType::u32, {kSampleWords * nonfinite.size()}, std::as_bytes(nonfinite)});

  Metadata metadata = content.model.metadata;
  metadata["format"] = kFormat;
  metadata["version"] = fmt::format("{}", kVersion);
  metadata[kPhase] = phase_name(progress.phase);
  metadata[kSamples] = fmt::format("{}", progress.samples);
  metadata[kFirstStep] = fmt::format("{}", progress.first_step);
  metadata[kTaught] = progress.has_training_samples ? "yes" : "no";
  metadata[kHasCache] = cache ? "yes" : "no";
  add_texts(metadata, kOptions, identity.options);
  add_texts(metadata, kScene, identity.scene);
  const auto add = [&](const char* name, const auto& value) {
    metadata[fmt::format("{}.{}", kStatistics, name)] = fmt::format("{}", value);
  };
  each_sum(add, statistics);
  each_last(add, statistics);
  metadata[kDigestKey] = content_digest(tensors, metadata);

  write_safetensors(path, tensors, metadata);
}

Checkpoint::Checkpoint(const std::filesystem::path& path) : file_(path) {
  neural::expect_text(file_, "format", "format", kFormat);
  neural::expect_version(file_, kVersion);
  const std::string phase = text_at(file_, kPhase);
  if (phase != phase_name(Phase::train) && phase != phase_name(Phase::render))
    file_.fail(fmt::format("phase: '{}', expected train or render", phase));
  progress_.phase = phase == phase_name(Phase::train) ? Phase::train : Phase::render;
  progress_.samples = number_at<int>(file_, kSamples);
  progress_.first_step = number_at<std::uint64_t>(file_, kFirstStep);
  progress_.has_training_samples = text_at(file_, kTaught) == "yes";
  if (text_at(file_, kHasCache) == "yes") cache_setup_ = read_cache_setup(file_);
}

void Checkpoint::expect(const CheckpointIdentity& identity, int spp) const {
  const std::string differences = list_differences(file_.metadata(), kOptions, identity.options);
  if (!differences.empty()) file_.fail(fmt::format("it has other options: {}", differences));
  expect_scene(file_, identity.scene);
  if (cache_setup_ && cache_setup_->sides.size() != identity.instances)
    file_.fail(
        fmt::format("sides of {} instances, expected {}", cache_setup_->sides.size(), identity.instances));
  if (progress_.samples > spp)
    file_.fail(fmt::format("spp: file {}, expected at most {}", progress_.samples, spp));
}

const CacheSetup& Checkpoint::cache_setup() const {
  if (!cache_setup_) file_.fail("it holds no cache");
  return *cache_setup_;
}

void Checkpoint::restore(Film& film, RenderStatistics& statistics) {
  if (progress_.samples > 0 || progress_.has_training_samples) {
    FilmSums sums = film.sums();  // has the expected sizes
    FilmSums::each_plane(sums, [&](const char* plane_of_film, auto& plane) {
      const std::string name = plane_name(plane_of_film);
      const std::uint64_t shape[] = {words_of(plane)};
      file_.read(name, TensorType::u32, shape, std::as_writable_bytes(std::span(plane)));
      // A film never holds a value that is not finite; the resumed picture would show it.
      const auto bad =
          std::find_if(plane.begin(), plane.end(), [](const auto& sum) { return !is_finite(sum); });
      if (bad != plane.end())
        file_.fail(fmt::format("tensor '{}': sum {} is not finite", name, bad - plane.begin()));
    });
    film.set_sums(std::move(sums));
  }
  const auto read = [&](const char* name, auto& value) {
    value =
        number_at<std::remove_reference_t<decltype(value)>>(file_, fmt::format("{}.{}", kStatistics, name));
  };
  each_sum(read, statistics);
  each_last(read, statistics);
  statistics.nonfinite_samples = read_nonfinite(file_);
  statistics.spp = progress_.samples;
}

void Checkpoint::expect_model(const neural::Model& model, const neural::TrainingOptions& options) const {
  neural::expect_model(file_, model, options);
}

CacheState Checkpoint::read_cache(const neural::Model& model, const neural::TrainingOptions& options) {
  cache_setup();
  CacheState state = read_cache_state(file_, model, options, own_tensors());
  state.guard = read_guard(file_, state.steps);
  return state;
}

}  // namespace gatelight::renderer
