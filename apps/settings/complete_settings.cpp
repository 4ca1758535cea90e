#include "apps/settings/complete_settings.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "apps/settings/camera_names.h"
#include "apps/settings/file_names.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/view_file.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/version.h"
#include "base/platform/threads.h"
#include "renderer/image/image_read.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using namespace renderer;

/// 16384 x 16384: beyond it the film by itself needs more than 4 GiB.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

Vec3 vector(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

std::string text(const std::array<float, 3>& v) {
  return fmt::format("{},{},{}", v[0], v[1], v[2]);
}

void complete_view(RenderSettings& settings) {
  if (settings.render.camera.fov_degrees && settings.render.camera.focal_mm)
    throw BadOption({"fov", "", "excludes `lens`", "one of them"});
  const LensOptions& lens = settings.render.camera.lens;
  const bool sharp = !(lens.aperture > 0.0f) && !(lens.f_stop > 0.0f);
  for (const auto& [name, used] : {std::pair("focus", !lens.focus.empty()), {"blades", lens.blades > 0}}) {
    if (sharp && used && settings.given.contains(name))
      throw BadOption({name, "", "has no effect without an aperture", "`aperture`"});
  }
  if (!settings.eye && !settings.target && !settings.up) return;
  if (!settings.eye || !settings.target) {
    throw BadOption({settings.eye ? "target" : "eye", "", "is missing", "both `eye` and `target`"});
  }
  LookAt look_at{.eye = vector(*settings.eye), .target = vector(*settings.target)};
  if (settings.up) look_at.up = vector(*settings.up);
  // In double: the difference of two floats may overflow or vanish in their square.
  const Eigen::Vector3d direction = look_at.target.cast<double>() - look_at.eye.cast<double>();
  const Eigen::Vector3d up = look_at.up.cast<double>();
  if (direction.norm() == 0.0) {
    throw BadOption({"target", text(*settings.target), "is the position of `eye`", "another"});
  }
  if (up.norm() == 0.0) throw BadOption({"up", "0,0,0", "is not a direction", "a vector that is not zero"});
  if (direction.normalized().cross(up.normalized()).norm() < 1e-6) {
    throw BadOption({"up", fmt::format("{},{},{}", up.x(), up.y(), up.z()), "is parallel to the view",
                     "another direction"});
  }
  if (!settings.render.camera.name.empty()) {
    throw BadOption({"camera", settings.render.camera.name, "excludes `eye`", "one of them"});
  }
  settings.render.camera.look_at = look_at;
}

void complete_frames(RenderSettings& settings) {
  FrameSettings& frames = settings.frames;
  if (frames.turntable > 0 && !frames.range) frames.range = FrameList{{{0, frames.turntable - 1}}};
  settings.load.shutter = frames.shutter_seconds();
  if (!frames.range) {
    if (settings.given.contains("fps") && !frames.shutter.is_open())
      throw BadOption({"fps", "", "there are no frames", "`frames` or `turntable`"});
    if (frames.shutter.is_open() && !settings.load.time)
      throw BadOption({"shutter", "", "has no effect without a time", "`time` or `frames`"});
    return;
  }
  if (settings.load.time) throw BadOption({"time", "", "excludes `frames`", "one of them"});
  settings.load.time = frames.seconds(0);
}

/// Files of several frames need a place for their number; those of one picture have none.
void check_frame_names(const RenderSettings& settings) {
  const auto check = [&](const char* option, const std::string& name) {
    if (name.empty()) return;
    if (!settings.frames.range) return refuse_frame_place(option, name);
    if (!settings.frames.range->is_single()) require_frame_place(option, name);
  };
  for (const std::string& output : settings.outputs) check("output", output);
  check("stats", settings.stats);
}

void check_picture(const RenderOptions& options) {
  const std::int64_t pixels = static_cast<std::int64_t>(options.width) * options.height;
  if (pixels > kMaxPixels) {
    throw BadOption({"size", fmt::format("{}x{}", options.width, options.height),
                     fmt::format("has {} pixels", pixels), fmt::format("at most {}", kMaxPixels)});
  }
  if (!options.region) return;
  const auto [x0, y0, x1, y1] = *options.region;
  if (x1 > options.width || y1 > options.height) {
    throw BadOption({"region", fmt::format("{},{},{},{}", x0, y0, x1, y1), "reaches beyond the picture",
                     fmt::format("x1 <= {} and y1 <= {}", options.width, options.height)});
  }
}

ErrorParts no_cache(const RenderOptions& o) {
  return {.problem = fmt::format("the integrator '{}' has no cache", enum_name(o.integrator)),
          .expected = "`integrator` nao or nrc"};
}

/// Why an option has no effect here; without a problem where it has one.
ErrorParts why_without_effect(const Option& option, const RenderOptions& options) {
  ErrorParts why;
  for (const Requirement& need : option.marks.needs) {
    if (why.problem.empty() && !need.met(options))
      why = {.problem = "has no effect here", .expected = need.expected};
  }
  if (option.marks.of_cache && !uses_cache(options.integrator)) why = no_cache(options);
  why.option = option.name;
  return why;
}

/// A flag of the cache selects an integrator with a cache; light groups need path tracing.
void resolve_integrator(RenderSettings& settings) {
  RenderOptions& o = settings.render;
  if (settings.given.contains("spp")) o.spp_of_paths = 0;
  if (o.choose_integrator && !o.light_groups.empty()) o.integrator = Integrator::path;
  if (o.integrator == Integrator::path) renderer::use_integrator(o, Integrator::path);
  if (!o.choose_integrator) return;
  for (const Option& option : option_table(settings)) {
    if (option.marks.of_cache && settings.given.contains(option.name)) o.choose_integrator = false;
  }
}

void refuse_without_effect(RenderSettings& settings) {
  for (const Option& option : option_table(settings)) {
    const ErrorParts why = why_without_effect(option, settings.render);
    if (!why.problem.empty() && settings.given.contains(option.name)) throw BadOption(why);
  }
}

/// Where --spp is not given, an error or a time decides how many samples there are, and a time also how many
/// training steps of a preset.
void open_samples(RenderSettings& settings) {
  constexpr int kMaxForError = 65536;
  RenderOptions& o = settings.render;
  const bool timed = o.time_limit_seconds > 0.0;
  if (timed && settings.preset && !settings.given.contains("train-steps")) o.cache.train_steps.reset();
  if (settings.given.contains("spp") || (!timed && o.max_error <= 0.0)) return;
  if (!timed && uses_cache(o.integrator) && !o.cache.train_steps && o.cache.cache_in.empty())
    o.cache.train_steps = choose_training_steps(o, count_pixels(o));  // for the usual number of samples
  o.spp = timed ? kUnlimitedSpp : kMaxForError;
  o.spp_of_paths = 0;
}

/// Sets the values that defaults and presets leave open or wrong for this encoding and integrator.
void adapt_cache(RenderSettings& settings) {
  CacheOptions& o = settings.render.cache;
  if (!uses_cache(settings.render.integrator)) return;
  // The paper's presets count steps by triangle, which a hash grid does not have.
  if (o.encoding == neural::FeatureEncoding::hash_grid) {
    o.training.feature_step = neural::FeatureStep::per_node;
    o.candidates = 1;
  }
  if (o.source == TrainingSource::picture && !training_gives_samples(settings.render)) {
    if (settings.given.contains("training-points")) {
      throw BadOption({"training-points", "picture", "cannot be combined with these options",
                       "`view` final and no `candidates`, `samples-per-point` and `train-path-length`"});
    }
    o.source = TrainingSource::camera;
  }
  if (o.view == CacheOutput::cache && o.query_at != QueryAt::none) o.query_at = QueryAt::primary;
  // Occlusion is one number in [0, 1]: its loss needs no relative weight.
  if (settings.render.integrator == Integrator::nao && !settings.given.contains("loss")) {
    o.training.loss = neural::Loss::l2;
  }
}

/// Why a layer would be black; without a problem where it would not.
ErrorParts why_black(Aov aov, const RenderOptions& o, bool frames) {
  const auto integrator = [&](const char* problem, const char* expected) {
    return ErrorParts{.problem = fmt::format("the integrator '{}' {}", enum_name(o.integrator), problem),
                      .expected = expected};
  };
  switch (info_of(aov).needs) {
    case AovNeeds::nothing:
      return {};
    case AovNeeds::frames:
      return frames ? ErrorParts{}
                    : ErrorParts{.problem = "a still picture has no motion", .expected = "`frames`"};
    case AovNeeds::light:
      if (o.integrator == Integrator::ao || o.integrator == Integrator::nao)
        return integrator("renders no radiance", "`integrator` path or nrc");
      if (uses_cache(o.integrator) && o.cache.view == CacheOutput::cache)
        return {.problem = "the cache's answers have no parts", .expected = "`view` final"};
      return {};
    case AovNeeds::cache:
      return uses_cache(o.integrator) ? ErrorParts{} : no_cache(o);
    case AovNeeds::radiance_cache:
      if (!uses_cache(o.integrator)) return no_cache(o);
      return o.integrator == Integrator::nrc ? ErrorParts{}
                                             : integrator("stores no radiance", "`integrator` nrc");
    case AovNeeds::mesh_colors:
      if (!uses_cache(o.integrator)) return no_cache(o);
      return o.cache.encoding != neural::FeatureEncoding::hash_grid
                 ? ErrorParts{}
                 : ErrorParts{.problem = "the encoding 'hashgrid' stores nothing per triangle",
                              .expected = "`encoding` gate"};
  }
  return {};
}

/// Layers that would be black are left out of `all`, and refused otherwise.
void complete_aovs(RenderOptions& o, bool frames) {
  if (o.aovs.size() == std::size(kEnumNames<Aov>))
    std::erase_if(o.aovs, [&](Aov aov) { return !why_black(aov, o, frames).problem.empty(); });
  for (const Aov aov : o.aovs) {
    if (const ErrorParts why = why_black(aov, o, frames); !why.problem.empty())
      throw BadOption({"aov", enum_name(aov), "would be black: " + why.problem, why.expected});
  }
}

void check_checkpoint(const RenderSettings& settings) {
  const CheckpointOptions& checkpoint = settings.render.checkpoint;
  if (!checkpoint.file.empty()) return;
  if (checkpoint.resume)
    throw BadOption({"resume", "", "there is no checkpoint to continue from", "`checkpoint` FILE"});
  if (settings.given.contains("checkpoint-every"))
    throw BadOption({"checkpoint-every", "", "there is no checkpoint to write", "`checkpoint` FILE"});
}

void require_file(const std::string& what, const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw InputError(fmt::format("cannot read {} '{}': there is no such file", what, path));
  if (fs::is_directory(status))
    throw InputError(fmt::format("cannot read {} '{}': it is a folder", what, path));
}

void check_frame_groups(const RenderSettings& settings) {
  const FrameSettings& frames = settings.frames;
  if (frames.groups == 1) return;
  const RenderOptions& options = settings.render;
  const auto refuse = [](const char* problem, const std::string& expected) {
    throw BadOption({"frame-groups", "", problem, expected});
  };
  if (!frames.range) refuse("there are no frames", "`frames` or `turntable`");
  if (const std::size_t count = frames.range->numbers().size();
      count < static_cast<std::size_t>(frames.groups))
    refuse("there are fewer frames than groups", fmt::format("at most {}", count));
  if (!options.checkpoint.file.empty())
    refuse("a checkpoint needs all frames in one sequence",
           "no `checkpoint`; `skip-existing` skips finished frames");
  if (!options.choose_integrator) check_frame_groups(frames, options.integrator);
  if (options.denoise.denoiser != DenoiserKind::none && options.denoise.temporal)
    refuse("denoised frames reuse samples of the previous frame", "`temporal` off or `denoiser` none");
}

}  // namespace

std::uint64_t count_pixels(const RenderOptions& options) {
  const std::array<int, 4> r = options.region.value_or(std::array{0, 0, options.width, options.height});
  return static_cast<std::uint64_t>(r[2] - r[0]) * static_cast<std::uint64_t>(r[3] - r[1]);
}

std::set<std::string> options_without_effect(RenderSettings settings) {
  std::set<std::string> names;
  for (const Option& option : option_table(settings)) {
    if (!why_without_effect(option, settings.render).problem.empty()) names.insert(option.name);
  }
  return names;
}

void apply_display_defaults(RenderSettings& settings) {
  if (!settings.preset) return;
  const Integrator integrator = settings.render.integrator;
  const bool radiance = integrator == Integrator::nrc || integrator == Integrator::path;
  if (radiance && !settings.given.contains("exposure")) settings.exposure.reset();
  const bool finished = settings.preset == CachePreset::preview || settings.preset == CachePreset::standard ||
                        settings.preset == CachePreset::final;
  if (radiance && finished && !settings.given.contains("tonemap"))
    settings.image.display.tonemap = Tonemap::agx;
}

void check_frame_groups(const FrameSettings& frames, Integrator integrator) {
  if (frames.groups > 1 && uses_cache(integrator))
    throw BadOption(
        {"frame-groups", "",
         fmt::format("frames with a cache depend on the previous frame, and the integrator is '{}'",
                     enum_name(integrator)),
         "`integrator` path or ao"});
}

void complete_settings(RenderSettings& settings) {
  if (settings.quiet && settings.verbose) throw BadOption({"quiet", "", "excludes `verbose`", "one of them"});
  settings.image.display.exposure = settings.exposure.value_or(0.0f);
  read_view_file(settings);
  complete_view(settings);
  if (settings.render.environment.sky && settings.given.contains("environment"))
    throw BadOption({"sky", "", "excludes `environment`", "one of them"});
  complete_frames(settings);
  if (!settings.load.animation.empty() && !settings.load.time)
    throw BadOption({"animation", "", "has no effect without a time", "`time` or `frames`"});
  check_picture(settings.render);
  resolve_integrator(settings);
  check_light_groups(settings.render);
  refuse_without_effect(settings);
  adapt_cache(settings);
  open_samples(settings);
  complete_aovs(settings.render, settings.frames.range.has_value());
  settings.render.denoise.library = oidn_place(settings.render.denoise.library);
  check_checkpoint(settings);
  check_frame_groups(settings);
  check_frame_names(settings);
  check_stdout(settings.outputs, settings.stats);
  check_camera_names(settings);
  check_file_names({&settings, 1});
  if (settings.render.threads == 0) settings.render.threads = available_threads();
  settings.load.threads = settings.render.threads;
}

void check_inputs(const RenderSettings& settings) {
  if (!settings.scene.empty()) require_file("the scene", settings.scene);
  if (!settings.render.environment.file.empty()) {
    require_file("the environment", settings.render.environment.file);
    check_image_input(settings.render.environment.file);
  }
  if (const std::string& background = settings.render.background.file; !background.empty()) {
    require_file("the background", background);
    check_image_input(background);
  }
  if (const std::string& cache = settings.render.cache.cache_in; !cache.empty())
    require_file("the cache", cache);
}

void check_outputs(const RenderSettings& settings) {
  const auto first_name = [&frames = settings.frames.range](const std::string& name) {
    return frames ? name_in_given_folder(name, frames->first()) : name;
  };
  for (const std::string& output : settings.outputs) check_picture_output(first_name(output));
  check_display(settings.image.display);
  if (!settings.stats.empty() && settings.stats != "-") check_writable(first_name(settings.stats));
  if (const std::string& cache = settings.render.cache.cache_out; !cache.empty())
    check_writable(first_name(cache));
  if (!settings.render.checkpoint.file.empty()) check_writable(settings.render.checkpoint.file);
}

}  // namespace gatelight::apps
