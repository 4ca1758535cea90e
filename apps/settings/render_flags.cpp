#include "apps/settings/render_flags.h"

#include <algorithm>

#include "apps/settings/cache_flags.h"
#include "apps/settings/flags.h"
#include "apps/settings/render_settings.h"

namespace gatelight::apps {
namespace {

constexpr RealRange kNotNegative{0.0, 3.4e38};
/// Beyond, tangents leave single precision.
constexpr RealRange kFov{0.001, 179.9};
/// Beyond it 2^EV leaves the range of float.
constexpr RealRange kStops{-100.0, 100.0};
constexpr RealRange kFilterWidth{0.0, 32.0};
constexpr RealRange kAoDistance{.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true};
constexpr IntegerRange kSamplesPerPixel{1, 1 << 24};
constexpr IntegerRange kDepth{0, 65536};
constexpr IntegerRange kThreads{0, 1024};
constexpr IntegerRange kMebibytes{0, std::int64_t{1} << 40};

constexpr Choice<bool> kExr[] = {{"half", false}, {"float", true}};
constexpr Choice<bool> kMissing[] = {{"error", true}, {"warn", false}};
constexpr Choice<const char*> kIsa[] = {
    {"auto", "auto"}, {"scalar", "scalar"}, {"avx2", "avx2"}, {"avx512", "avx512"}};

void add_triple(CLI::App& app, const std::string& flag, std::optional<std::array<float, 3>>& value,
                const std::string& help, const std::string& default_text = "") {
  add_word(app, flag, "x,y,z", help, default_text,
           [&value, flag](const std::string& text) { value = parse_triple(flag, text, kAnyFloat); });
}

void set_environment(renderer::EnvironmentOptions& environment, const std::string& text) {
  environment.file.clear();
  environment.constant = scene::Color::Zero();
  if (text == "none") return;
  if (looks_like_triple(text)) {
    const std::array<float, 3> rgb = parse_triple("--environment", text, kNotNegative);
    environment.constant = {rgb[0], rgb[1], rgb[2]};
  } else {
    environment.file = text;
  }
}

void set_aovs(RenderSettings& s, const std::string& text) {
  std::vector<renderer::Aov>& aovs = s.render.aovs;
  aovs.clear();
  s.all_aovs = false;
  for (const std::string& word : split_list("--aov", text)) {
    if (word == "all") {
      s.all_aovs = true;
    } else {
      aovs.push_back(parse_choice("--aov", word, aov_choices()));
    }
  }
  std::sort(aovs.begin(), aovs.end());
  aovs.erase(std::unique(aovs.begin(), aovs.end()), aovs.end());
}

void add_size_flag(CLI::App& app, RenderSettings& s) {
  add_word(app, "--size", "WxH", "Size of the picture in pixels", "960x540",
           [&o = s.render](const std::string& text) {
             const auto [width, height] = parse_size("--size", text);
             o.width = width;
             o.height = height;
           })
      ->group("Picture");
}

void add_picture_flags(CLI::App& app, RenderSettings& s) {
  renderer::RenderOptions& o = s.render;
  add_size_flag(app, s);
  add_word(app, "--region", "x0,y0,x1,y1", "Render this part only, in pixels; x1 and y1 are excluded", "",
           [&o](const std::string& text) { o.region = parse_region("--region", text); });
  add_integer(app, "--spp", o.spp, kSamplesPerPixel, "N", "Samples per pixel");
  add_real(app, "--time-limit", o.time_limit_seconds, kNotNegative, "SECONDS",
           "Stop after the pass that reaches this time of rendering; 0: no limit", "0");
  add_integer(app, "--seed", o.seed, IntegerRange{0, 4294967295}, "N", "Seed of all random numbers");
  add_choice(app, "--sampler", o.sampler, sampler_choices(), "Kind of random numbers");
  add_choice(app, "--filter", o.filter, filter_choices(), "Pixel filter");
  add_real(app, "--filter-width", o.filter_width, kFilterWidth, "PIXELS",
           "Full width of the pixel filter; 0: the filter's own", "0");
  add_word(app, "--aov", "LIST",
           "Further layers of EXR files, separated by commas: albedo, normal, depth, position, primitive, "
           "instance, samples, variance; of a cache cache-answer, cache-error, training-count, resolution, "
           "nearest-node; or all",
           "", [&s](const std::string& text) { set_aovs(s, text); });
  for (CLI::Option* option : app.get_options()) {
    const bool grouped = option->get_group() != "Options" || option->get_positional();
    if (!grouped && option != app.get_help_ptr()) option->group("Picture");
  }
}

void add_integrator_flags(CLI::App& app, RenderSettings& s) {
  add_choice(
      app, "--integrator", s.render.integrator, integrator_choices(),
      "What a pixel is: radiance (path) or ambient occlusion (ao) by sampling alone, or what a cache learned "
      "of them answers (nrc, nao)")
      ->group("Light transport");
  add_preset_flag(app, s);
}

void add_light_flags(CLI::App& app, RenderSettings& s) {
  renderer::RenderOptions& o = s.render;
  const std::string group = "Light transport";
  add_integrator_flags(app, s);
  add_integer(app, "--max-depth", o.max_depth, kDepth, "N",
              "Largest number of scattering events; 1: emission and direct light")
      ->group(group);
  add_integer(app, "--min-depth", o.min_depth, kDepth, "N", "Russian roulette starts after this many events")
      ->group(group);
  add_choice(app, "--direct", o.direct, direct_choices(),
             "How light is found: by light samples (nee), by bounces (bsdf), or by both (mis)")
      ->group(group);
  add_choice(app, "--mis", o.mis, mis_choices(), "Heuristic of multiple importance sampling")->group(group);
  add_choice(app, "--light-selection", o.light_selection, light_selection_choices(),
             "How one of many lights is chosen")
      ->group(group);
  add_real(app, "--ao-distance", o.ao_distance, kAoDistance, "METRES",
           "Reach of ambient occlusion; inf allowed", "a tenth of the scene's diagonal")
      ->group(group);
  add_real(app, "--clamp", o.clamp, kNotNegative, "X", "Largest luminance of one sample (biased); 0: off",
           "0")
      ->group(group);
  add_choice(app, "--nan", o.nan_policy, nan_choices(), "What happens to a sample that is not finite")
      ->group(group);
}

void add_view_flags(CLI::App& app, RenderSettings& s) {
  renderer::RenderOptions& o = s.render;
  const std::string group = "Scene and view";
  app.add_option("--camera", o.camera.name, "Camera of the file, by name or index (default: the first)")
      ->type_name("NAME|INDEX")
      ->group(group);
  add_triple(app, "--eye", s.eye, "Look from here, in metres (with --target)");
  add_triple(app, "--target", s.target, "Look at this point, in metres");
  add_triple(app, "--up", s.up, "What is up in a view by hand", "0,1,0");
  for (const char* flag : {"--eye", "--target", "--up"}) app.get_option(flag)->group(group);
  add_word(app, "--fov", "DEGREES", "Vertical field of view; overrides the camera's", "",
           [&o](const std::string& text) { o.camera.fov_degrees = parse_float("--fov", text, kFov); })
      ->group(group);
  add_word(app, "--environment", "FILE|r,g,b|none",
           "Light from all around: a latitude-longitude EXR or HDR, or one radiance", "none",
           [&o](const std::string& text) { set_environment(o.environment, text); })
      ->group(group);
  add_real(app, "--environment-rotation", o.environment.rotation_degrees, kAnyFloat, "DEGREES",
           "Turns the environment about +y, counter-clockwise from above", "0")
      ->group(group);
  add_real(app, "--environment-scale", o.environment.scale, kNotNegative, "X", "Multiplies the environment",
           "1")
      ->group(group);
  add_integer(app, "--scene-index", s.load.scene, IntegerRange{-1, 1 << 30}, "N",
              "Which scene of the file; -1: its default")
      ->group(group);
  app.add_option("--variant", s.load.variant, "Material variant of the file, by name")
      ->type_name("NAME")
      ->group(group);
  add_choice(app, "--missing", s.load.missing_is_error, Choices<bool>(kMissing),
             "When a texture cannot be read")
      ->group(group);
  add_external_flag(app, s.load.allow_external, group);
}

void add_output_flags(CLI::App& app, RenderSettings& s) {
  const std::string group = "Output";
  app.add_option("-o,--output", s.outputs, "Picture to write, .exr or .png; may be given several times")
      ->type_name("FILE")
      ->required()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(group);
  add_choice(app, "--exr", s.image.exr_float, Choices<bool>(kExr), "Precision of colours in EXR files")
      ->group(group);
  add_real(app, "--exposure", s.image.exposure, kStops, "EV", "Stops by which PNG files are brighter", "0")
      ->group(group);
  add_choice(app, "--tonemap", s.image.tonemap, tonemap_choices(), "Curve of PNG files")->group(group);
  app.add_flag(
         "--reproducible", s.reproducible,
         "Leave times, threads and the command line out of the EXR header: equal renders give equal files")
      ->group(group);
  app.add_option("--stats", s.stats, "Statistics as JSON; - is stdout")->type_name("FILE|-")->group(group);
  add_choice(app, "--progress", s.progress, progress_choices(),
             "Progress on stderr; auto: a bar on a terminal")
      ->group(group);
  app.add_flag("--quiet", s.quiet, "Say nothing but errors")->group(group);
  app.add_flag("--verbose", s.verbose, "Say more: what was loaded, the memory needed, all options")
      ->group(group);
}

void add_file_flags(CLI::App& app, RenderSettings& s) {
  const std::string group = "Files";
  renderer::CheckpointOptions& checkpoint = s.render.checkpoint;
  app.add_option("--checkpoint", checkpoint.file,
                 "Keep all that is needed to go on after the program was ended in this file")
      ->type_name("FILE")
      ->group(group);
  add_word(app, "--checkpoint-every", "SECONDS", "Time between two writes of it", "60",
           [&s](const std::string& text) {
             s.checkpoint_every = parse_real("--checkpoint-every", text, kNotNegative);
           })
      ->group(group);
  app.add_flag("--resume", checkpoint.resume,
               "Go on with the checkpoint where it is there: the same picture as without the break")
      ->group(group);
  add_cache_file_flags(app, s);
}

void add_threads_flag(CLI::App& app, RenderSettings& s) {
  add_integer(app, "--threads", s.render.threads, kThreads, "N",
              "0: all that the machine and the control group allow")
      ->group("Machine");
}

void add_machine_flags(CLI::App& app, RenderSettings& s) {
  const std::string group = "Machine";
  add_threads_flag(app, s);
  add_word(app, "--memory-limit", "MIB", "Refuse to need more memory than this, in MiB; 0: no limit", "0",
           [&s](const std::string& text) {
             s.render.memory_limit_bytes =
                 static_cast<std::size_t>(parse_integer("--memory-limit", text, kMebibytes)) << 20;
           })
      ->group(group);
  add_word(app, "--isa", choice_names(Choices<const char*>(kIsa)),
           "Instruction set of ray tracing and of the cache", "auto",
           [&s](const std::string& text) {
             s.render.isa = parse_choice("--isa", text, Choices<const char*>(kIsa));
           })
      ->group(group);
}

}  // namespace

void add_external_flag(CLI::App& app, bool& allowed, const std::string& group) {
  app.add_flag("--allow-external", allowed,
               "Let the scene read files outside its own folder: do so for scenes that you trust")
      ->group(group);
}

void add_render_flags(CLI::App& app, RenderSettings& settings) {
  app.add_option("SCENE", settings.scene, "Scene, .gltf or .glb")->required()->type_name("");
  add_output_flags(app, settings);
  add_file_flags(app, settings);
  add_picture_flags(app, settings);
  add_view_flags(app, settings);
  add_light_flags(app, settings);
  add_cache_flags(app, settings);
  add_machine_flags(app, settings);
}

void add_cache_report_flags(CLI::App& app, RenderSettings& settings) {
  add_integrator_flags(app, settings);
  add_size_flag(app, settings);
  add_view_flags(app, settings);
  add_cache_flags(app, settings);
  add_threads_flag(app, settings);
}

}  // namespace gatelight::apps
