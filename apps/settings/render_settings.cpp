#include "apps/settings/render_settings.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <set>
#include <string_view>

#include "apps/terminal/errors.h"
#include "renderer/machine/threads.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using namespace renderer;

/// 16384 x 16384: beyond it the film alone needs more than 4 GiB.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

constexpr Choice<Integrator> kIntegrators[] = {
    {"path", Integrator::path}, {"ao", Integrator::ao}, {"nao", Integrator::nao}, {"nrc", Integrator::nrc}};
constexpr Choice<SamplerKind> kSamplers[] = {{"sobol", SamplerKind::sobol},
                                             {"independent", SamplerKind::independent}};
constexpr Choice<PixelFilter> kFilters[] = {{"box", PixelFilter::box},
                                            {"tent", PixelFilter::tent},
                                            {"gaussian", PixelFilter::gaussian},
                                            {"blackman-harris", PixelFilter::blackman_harris}};
constexpr Choice<MisHeuristic> kMis[] = {{"balance", MisHeuristic::balance}, {"power", MisHeuristic::power}};
constexpr Choice<DirectLight> kDirect[] = {
    {"mis", DirectLight::mis}, {"nee", DirectLight::nee}, {"bsdf", DirectLight::bsdf}};
constexpr Choice<LightSelection> kLightSelections[] = {{"tree", LightSelection::tree},
                                                       {"power", LightSelection::power}};
constexpr Choice<NanPolicy> kNan[] = {{"drop", NanPolicy::drop}, {"error", NanPolicy::error}};
constexpr Choice<Aov> kAovs[] = {{"albedo", Aov::albedo},
                                 {"normal", Aov::normal},
                                 {"depth", Aov::depth},
                                 {"position", Aov::position},
                                 {"primitive", Aov::primitive_id},
                                 {"instance", Aov::instance_id},
                                 {"samples", Aov::sample_count},
                                 {"variance", Aov::variance},
                                 {"cache-answer", Aov::cache_answer},
                                 {"cache-error", Aov::cache_error},
                                 {"training-count", Aov::training_count},
                                 {"resolution", Aov::resolution},
                                 {"nearest-node", Aov::nearest_node}};
constexpr Choice<Tonemap> kTonemaps[] = {{"none", Tonemap::none}, {"filmic", Tonemap::filmic}};
constexpr Choice<ProgressMode> kProgress[] = {{"auto", ProgressMode::automatic},
                                              {"bar", ProgressMode::bar},
                                              {"json", ProgressMode::json},
                                              {"none", ProgressMode::none}};

scene::Vec3 vector(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

std::string text(const std::array<float, 3>& v) {
  return fmt::format("{},{},{}", v[0], v[1], v[2]);
}

void complete_view(RenderSettings& settings) {
  if (!settings.eye && !settings.target && !settings.up) return;
  if (!settings.eye || !settings.target) {
    throw UsageError(fmt::format("{} is missing: a view by hand needs --eye and --target",
                                 settings.eye ? "--target" : "--eye"));
  }
  LookAt look_at{.eye = vector(*settings.eye), .target = vector(*settings.target)};
  if (settings.up) look_at.up = vector(*settings.up);
  // In double: the difference of two floats may overflow or vanish in their square.
  const Eigen::Vector3d direction = look_at.target.cast<double>() - look_at.eye.cast<double>();
  const Eigen::Vector3d up = look_at.up.cast<double>();
  if (direction.norm() == 0.0) {
    throw UsageError(
        fmt::format("--target: '{}' is the place of --eye, expected another", text(*settings.target)));
  }
  if (up.norm() == 0.0) throw UsageError("--up: '0,0,0' is no direction, expected a vector that is not zero");
  if (direction.normalized().cross(up.normalized()).norm() < 1e-6) {
    throw UsageError(fmt::format("--up: '{},{},{}' is parallel to the view, expected another direction",
                                 up.x(), up.y(), up.z()));
  }
  if (!settings.render.camera.name.empty()) {
    throw UsageError(fmt::format("--camera: '{}' and --eye exclude each other, expected one of them",
                                 settings.render.camera.name));
  }
  settings.render.camera.look_at = look_at;
}

void check_picture(const RenderOptions& options) {
  const std::int64_t pixels = static_cast<std::int64_t>(options.width) * options.height;
  if (pixels > kMaxPixels) {
    throw UsageError(fmt::format("--size: '{}x{}' has {} pixels, expected at most {}", options.width,
                                 options.height, pixels, kMaxPixels));
  }
  if (!options.region) return;
  const auto [x0, y0, x1, y1] = *options.region;
  if (x1 > options.width || y1 > options.height) {
    throw UsageError(
        fmt::format("--region: '{},{},{},{}' reaches beyond the picture, expected x1 <= {} and y1 <= {}", x0,
                    y0, x1, y1, options.width, options.height));
  }
}

void check_file_names(const RenderSettings& settings) {
  FileNames names = read_files(settings);
  for (const std::string& output : settings.outputs) names.write("--output", output);
  names.write("--stats", settings.stats);
  names.write("--cache-out", settings.render.cache.cache_out, "--cache-in");
  names.write("--checkpoint", settings.render.checkpoint.file);
}

/// Flags of one encoding, rule or integrator, which another would silently ignore.
struct Condition {
  bool holds = true;
  std::string_view expected;
  std::vector<std::string_view> flags;
};

std::vector<Condition> cache_conditions(const RenderOptions& options) {
  const CacheOptions& o = options.cache;
  const bool gate = o.encoding == neural::FeatureEncoding::gate;
  const bool nrc = options.integrator == Integrator::nrc;
  return {
      {nrc,
       "--integrator nrc",
       {"--cache-holds", "--query-at", "--view", "--self-training", "--self-training-vertices",
        "--self-training-full", "--self-training-attenuation", "--train-path-length", "--cache-roughness",
        "--spread-threshold", "--direction-input"}},
      {nrc || !gate, "--integrator nrc or --encoding hashgrid", {"--albedo-input"}},
      {o.self_training.start_step >= 0,
       "--self-training STEP",
       {"--self-training-vertices", "--self-training-full", "--self-training-attenuation"}},
      {o.query_at == QueryAt::spread, "--query-at spread", {"--spread-threshold"}},
      // The bare answer is that of the first vertex, or what should have been it.
      {o.view == CacheView::final || o.query_at == QueryAt::primary || o.query_at == QueryAt::none,
       "--view final",
       {"--query-at"}},
      {gate || o.candidates == 1, "--encoding gate", {"--candidates"}},
      {gate,
       "--encoding gate",
       {"--features", "--stack", "--resolution", "--resolution-scale", "--node-spacing", "--max-resolution",
        "--cluster", "--storage", "--feature-step"}},
      {!gate,
       "--encoding hashgrid",
       {"--hash-levels", "--hash-features", "--hash-log2-size", "--hash-base", "--hash-growth"}},
      {o.gate.rule == neural::ResolutionRule::paper, "--resolution paper", {"--resolution-scale"}},
      {o.gate.rule == neural::ResolutionRule::uniform, "--resolution uniform", {"--node-spacing"}},
  };
}

/// What defaults and presets leave open or wrong for this encoding and integrator.
void adapt_cache(RenderSettings& settings) {
  CacheOptions& o = settings.render.cache;
  // The paper's presets count steps by triangle, which a hash grid does not know.
  if (o.encoding == neural::FeatureEncoding::hash_grid) {
    o.training.feature_step = neural::FeatureStep::per_node;
    o.candidates = 1;
  }
  if (o.view == CacheView::cache && o.query_at != QueryAt::none) o.query_at = QueryAt::primary;
  // One number alone is compared with itself: its loss needs no weight.
  if (settings.render.integrator == Integrator::nao && !settings.given.contains("--loss")) {
    o.training.loss = neural::Loss::l2;
  }
}

void complete_cache(RenderSettings& settings) {
  RenderOptions& o = settings.render;
  if (!uses_cache(o.integrator)) {
    for (const std::string& flag : settings.cache_flags) {
      if (settings.given.contains(flag)) {
        throw UsageError(fmt::format("{}: the integrator '{}' has no cache, expected --integrator nao or nrc",
                                     flag, name_of(integrator_choices(), o.integrator)));
      }
    }
    return;
  }
  for (const Condition& condition : cache_conditions(o)) {
    for (const std::string_view flag : condition.flags) {
      if (!condition.holds && settings.given.contains(std::string(flag))) {
        throw UsageError(
            fmt::format("{}: it has no effect here, expected it with {}", flag, condition.expected));
      }
    }
  }
  adapt_cache(settings);
}

/// Why a layer would be black, and what it needs; empty where it shows something.
std::string why_black(Aov aov, const RenderOptions& o) {
  if (!shows_cache(aov)) return "";
  if (!uses_cache(o.integrator)) {
    return fmt::format("the integrator '{}' has no cache, expected --integrator nao or nrc",
                       name_of(integrator_choices(), o.integrator));
  }
  if (aov == Aov::cache_error && o.integrator == Integrator::nao) {
    return "the integrator 'nao' has no record to compare with, expected --integrator nrc";
  }
  const bool of_triangles = aov == Aov::training_count || aov == Aov::resolution || aov == Aov::nearest_node;
  if (of_triangles && o.cache.encoding == neural::FeatureEncoding::hash_grid) {
    return "the encoding 'hashgrid' knows no triangles, expected --encoding gate";
  }
  return "";
}

void complete_aovs(RenderSettings& settings) {
  RenderOptions& o = settings.render;
  if (settings.all_aovs) {
    o.aovs.clear();
    for (const Choice<Aov>& choice : aov_choices()) {
      if (why_black(choice.value, o).empty()) o.aovs.push_back(choice.value);
    }
  }
  for (const Aov aov : o.aovs) {
    const std::string why = why_black(aov, o);
    if (!why.empty()) {
      throw UsageError(fmt::format("--aov: '{}' would be black: {}", name_of(aov_choices(), aov), why));
    }
  }
}

void complete_checkpoint(RenderSettings& settings) {
  CheckpointOptions& checkpoint = settings.render.checkpoint;
  if (checkpoint.file.empty() && checkpoint.resume) {
    throw UsageError("--resume: there is nothing to go on with, expected --checkpoint FILE with it");
  }
  if (checkpoint.file.empty() && settings.checkpoint_every) {
    throw UsageError("--checkpoint-every: there is nothing to write, expected --checkpoint FILE with it");
  }
  if (settings.checkpoint_every) checkpoint.every_seconds = *settings.checkpoint_every;
}

void require_file(const std::string& what, const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw InputError(fmt::format("cannot read {} '{}': there is no such file", what, path));
  if (fs::is_directory(status))
    throw InputError(fmt::format("cannot read {} '{}': it is a folder", what, path));
}

}  // namespace

FileNames read_files(const RenderSettings& settings) {
  FileNames names;
  names.read("SCENE", settings.scene);
  names.read("--environment", settings.render.environment.file);
  names.read("--config", settings.config);
  names.read("--cache-in", settings.render.cache.cache_in);
  return names;
}

Choices<Integrator> integrator_choices() {
  return kIntegrators;
}
Choices<SamplerKind> sampler_choices() {
  return kSamplers;
}
Choices<PixelFilter> filter_choices() {
  return kFilters;
}
Choices<MisHeuristic> mis_choices() {
  return kMis;
}
Choices<DirectLight> direct_choices() {
  return kDirect;
}
Choices<LightSelection> light_selection_choices() {
  return kLightSelections;
}
Choices<NanPolicy> nan_choices() {
  return kNan;
}
Choices<Aov> aov_choices() {
  return kAovs;
}
Choices<Tonemap> tonemap_choices() {
  return kTonemaps;
}
Choices<ProgressMode> progress_choices() {
  return kProgress;
}

std::set<std::string> cache_flags_without_effect(const RenderOptions& options) {
  std::set<std::string> flags;
  for (const Condition& condition : cache_conditions(options)) {
    if (!condition.holds) flags.insert(condition.flags.begin(), condition.flags.end());
  }
  return flags;
}

void complete_settings(RenderSettings& settings) {
  if (settings.quiet && settings.verbose)
    throw UsageError("--quiet and --verbose exclude each other, expected one");
  complete_view(settings);
  check_picture(settings.render);
  complete_cache(settings);
  complete_aovs(settings);
  complete_checkpoint(settings);
  check_file_names(settings);
  if (settings.render.threads == 0) settings.render.threads = available_threads();
}

void check_files(const RenderSettings& settings) {
  require_file("the scene", settings.scene);
  if (!settings.render.environment.file.empty()) {
    require_file("the environment", settings.render.environment.file);
  }
  for (const std::string& output : settings.outputs) check_image_output(output);
  if (!settings.stats.empty() && settings.stats != "-") check_writable(settings.stats);
  const CacheOptions& cache = settings.render.cache;
  if (!cache.cache_in.empty()) require_file("the cache", cache.cache_in);
  if (!cache.cache_out.empty()) check_writable(cache.cache_out);
  if (!settings.render.checkpoint.file.empty()) check_writable(settings.render.checkpoint.file);
}

}  // namespace gatelight::apps
