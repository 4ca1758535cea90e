#include "renderer/settings/option_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "renderer/machine/errors.h"

// Structured bindings name every member of the structs: a new member does not compile until it is described
// here.

namespace gatelight::renderer {
namespace {

constexpr IntegerRange kDepth{0, 65536};
constexpr IntegerRange kMebibytes{0, std::int64_t{1} << 40};
constexpr Choice<std::string_view> kIsa[] = {
    {"auto", "auto"}, {"scalar", "scalar"}, {"avx2", "avx2"}, {"avx512", "avx512"}};

constexpr Choice<int> kSupersampling[] = {{"1", 1}, {"2", 2}};

/// Values by a list of words, each once, in the order of the enumeration. `all`: a word for all of them.
template <class Enumeration>
std::vector<Enumeration> read_words(const std::string& flag, const std::string& text,
                                    std::string_view all = "") {
  std::vector<Enumeration> values;
  for (const std::string& word : split_list(flag, text)) {
    if (word == all) {
      for (const Choice<Enumeration>& choice : kWords<Enumeration>) values.push_back(choice.value);
    } else {
      values.push_back(parse_choice(flag, word, kWords<Enumeration>));
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

template <class Enumeration>
OptionValue words_of(const std::vector<Enumeration>& values) {
  std::vector<std::string> words;
  for (const Enumeration value : values) words.push_back(word(value));
  return words;
}

void add_checkpoint_options(std::vector<Option>& table, CheckpointOptions& checkpoint) {
  auto& [file, every_seconds, resume] = checkpoint;
  OptionGroup files{table, "Files"};
  const auto add = [&](Option option) {
    option.default_text = option.text();
    option.value = [&checkpoint, value = option.value] {
      return checkpoint.file.empty() ? OptionValue() : value();
    };
    files.add(decides_nothing(option, InRecipe::unless_reproducible));
  };
  add(any_word("checkpoint", file, "FILE",
               "Write a file from which --resume continues after the program has ended"));
  add(number("checkpoint-every", every_seconds, kNotNegative, "SECONDS",
             "Time between two writes of the checkpoint"));
  add(toggle(
      "resume", resume,
      "Continue from the checkpoint if it exists; the picture is the same as without the interruption"));
}

Option size_option(int& width, int& height) {
  const auto value = [&]() -> OptionValue { return std::vector<int>{width, height}; };
  const auto read = [&](const std::string& text) {
    const std::array<int, 2> size = parse_size("--size", text);
    width = size[0];
    height = size[1];
  };
  return {.name = "size",
          .unit = "WxH",
          .help = "Size of the picture in pixels",
          .value = value,
          .read = read,
          .write = [&] { return fmt::format("{}x{}", width, height); }};
}

Option region_option(std::optional<std::array<int, 4>>& region) {
  const auto value = [&] {
    return region ? std::vector<int>(region->begin(), region->end()) : OptionValue();
  };
  return {.name = "region",
          .unit = "x0,y0,x1,y1",
          .help = "Render this part only, in pixels; x1 and y1 are excluded",
          .value = value,
          .read = [&](const std::string& text) { region = parse_region("--region", text); },
          .if_none = "all"};
}

Option aov_option(std::vector<Aov>& aovs) {
  const char* help =
      "Further layers of EXR files, separated by commas: albedo, normal, depth, position, primitive, "
      "instance, alpha, samples, variance, raw (the mean of the samples), error (the estimated standard "
      "error of the picture), denoising (what `gatelight denoise` reads); of a cache cache-radiance, "
      "cache-answer, cache-error, "
      "training-count, resolution, nearest-node; or all";
  return {.name = "aov",
          .unit = "LIST",
          .help = help,
          .value = [&] { return words_of(aovs); },
          .read = [&](const std::string& text) { aovs = read_words<Aov>("--aov", text, "all"); }};
}

Option cryptomatte_option(std::vector<MatteKind>& kinds) {
  return {.name = "cryptomatte",
          .unit = "object,material",
          .help =
              "Masks for compositing in EXR files, by the names of objects, of materials or of both: the "
              "layers of the Cryptomatte specification, six names a pixel; glass and mirrors are objects "
              "themselves",
          .value = [&]() -> OptionValue { return kinds.empty() ? OptionValue() : words_of(kinds); },
          .read = [&](const std::string& text) { kinds = read_words<MatteKind>("--cryptomatte", text); }};
}

Option light_groups_option(std::vector<LightGroup>& groups) {
  return {.name = "light-groups",
          .unit = "none|A=LIGHT,LIGHT;B=...",
          .help =
              "Layers of EXR files, light-A and so on, with the part of these lights and emissive "
              "materials of the file, by name ('*' ends a name that only begins so), or of the "
              "environment; 'rest' is that of all others; with --integrator path: "
              "\"key=Sun,Lamp*;sky=environment\"",
          .value = [&]() -> OptionValue { return groups.empty() ? OptionValue() : text_of(groups); },
          .read = [&](const std::string& text) { groups = read_light_groups(text); },
          .if_none = "none"};
}

void read_environment(EnvironmentOptions& environment, const std::string& text) {
  environment.automatic = text == "auto";
  environment.file.clear();
  environment.constant = scene::Color::Zero();
  if (text == "none" || text == "auto") return;
  if (looks_like_triple(text)) {
    const std::array<float, 3> rgb = parse_triple("--environment", text, kNotNegative);
    environment.constant = {rgb[0], rgb[1], rgb[2]};
  } else {
    environment.file = text;
  }
}

OptionValue environment_value(const EnvironmentOptions& environment) {
  if (environment.automatic) return "auto";
  if (environment.none()) return "none";
  if (!environment.file.empty()) return environment.file;
  const scene::Color& rgb = environment.constant;
  return std::vector<float>{rgb.x(), rgb.y(), rgb.z()};
}

void read_background(BackgroundOptions& background, const std::string& text) {
  using Kind = BackgroundOptions::Kind;
  background = {.shadow_catcher = background.shadow_catcher};
  if (text == "scene") return;
  if (text == "transparent") {
    background.kind = Kind::transparent;
  } else if (looks_like_triple(text)) {
    const std::array<float, 3> rgb = parse_triple("--background", text, kNotNegative);
    background.kind = Kind::color;
    background.color = {rgb[0], rgb[1], rgb[2]};
  } else {
    background.kind = Kind::file;
    background.file = text;
  }
}

OptionValue background_value(const BackgroundOptions& background) {
  using Kind = BackgroundOptions::Kind;
  if (background.kind == Kind::scene) return "scene";
  if (background.kind == Kind::transparent) return "transparent";
  if (background.kind == Kind::file) return background.file;
  return std::vector<float>{background.color.x(), background.color.y(), background.color.z()};
}

void read_aperture(LensOptions& lens, const std::string& text) {
  const RealRange range{.min = 0.0, .max = 1e6};
  const bool stops = text.starts_with("f/");
  const auto value = static_cast<float>(parse_real("--aperture", stops ? text.substr(2) : text, range));
  if (stops && !(value > 0.0f))
    throw BadOption(fmt::format("--aperture: '{}' is no f-stop, expected more than 0", text));
  lens.f_stop = stops ? value : 0.0f;
  lens.aperture = stops ? 0.0f : value;
}

void add_lens_options(OptionGroup& view, LensOptions& lens) {
  [[maybe_unused]] auto& [aperture, f_stop, focus, blades] = lens;  // one flag sets the first two
  const auto add = [&](Option option) -> Option& { return view.add(decides_nothing(std::move(option))); };
  const auto aperture_value = [&lens]() -> OptionValue {
    return lens.f_stop > 0.0f ? fmt::format("f/{}", lens.f_stop) : fmt::format("{}", lens.aperture);
  };
  add({.name = "aperture",
       .unit = "f/N|METRES",
       .help =
           "Opening of the lens, as an f-stop or its diameter: what is not in focus is blurred; 0: all is "
           "sharp",
       .value = aperture_value,
       .read = [&lens](const std::string& text) { read_aperture(lens, text); }});
  add(any_word(
          "focus", focus, "METRES|NODE",
          "With --aperture: distance along the view, or an object (default: what the middle of the picture "
          "sees, told)"))
      .value = [&lens] { return lens.focus.empty() ? OptionValue() : lens.focus; };
  add(number("blades", blades, {0, 64}, "N", "With --aperture: its corners; 0: round"));
}

/// Checkpoints store the chosen camera and the scene's fingerprint instead.
void add_view_options(std::vector<Option>& table, CameraOptions& camera, EnvironmentOptions& environment,
                      BackgroundOptions& background) {
  OptionGroup view{table, "Scene and view"};
  const auto add = [&](Option option) -> Option& { return view.add(decides_nothing(std::move(option))); };
  // Flags of the application set look_at.
  [[maybe_unused]] auto& [name, index, look_at, fov_degrees, focal_mm, projection, view_height, lens] =
      camera;
  add(any_word("camera", name, "NAME|INDEX",
               "Camera of the file, by its name, its node's or its index (default: the first); all of "
               "them with 'all' and {camera} in the outputs' names"))
      .value = [&camera] { return camera.look_at || camera.name.empty() ? OptionValue() : camera.name; };
  // Beyond these bounds tangents leave the range of single precision.
  add(number_or("", "fov", fov_degrees, {0.001, 179.9}, "DEGREES",
                "Vertical field of view; overrides the camera's"));
  add(number_or("", "lens", focal_mm, {0.1, 1e5}, "MM",
                "The same by a focal length, with 36 mm across the wider side of the picture"));
  add(choice("projection", projection,
             "As the camera of the file, or one of these; a panorama shows all directions around the camera "
             "(latitude-longitude, expected twice as wide as high)"));
  add(number_or("", "view-height", view_height, {.min = 0.0, .max = 2e12, .excludes_min = true}, "METRES",
                "What an orthographic picture shows from bottom to top"));
  add_lens_options(view, lens);
  [[maybe_unused]] auto& [automatic, file, constant, sky, rotation_degrees, scale] =
      environment;  // one flag sets the first three
  add({.name = "environment",
       .unit = "auto|none|r,g,b|FILE",
       .help = "Light from all around: a soft sky if the scene has no light (auto), one radiance, or a "
               "latitude-longitude EXR or HDR",
       .value = [&environment] { return environment_value(environment); },
       .read = [&environment](const std::string& text) { read_environment(environment, text); }});
  add({.name = "sky",
       .unit = "none|clear|PART=VALUE,...",
       .help = "Instead of --environment a clear sky with a sun: turbidity=3, sun=AZIMUTH,ELEVATION "
               "(degrees; north "
               "is -z, east +x), ground=ALBEDO, size=0.53 (of the sun's disc in degrees; 0: a directional "
               "light), "
               "intensity=1; or date=2026-06-21, time=14:30, place=LATITUDE,LONGITUDE, zone=+2 instead of "
               "the sun; "
               "a white surface in full daylight has a radiance of 1",
       .value = [&environment]() -> OptionValue {
         return environment.sky ? text_of(*environment.sky) : "none";
       },
       .read =
           [&environment](const std::string& text) {
             environment.sky.reset();
             if (text != "none") environment.sky = read_sky("--sky", text);
           }});
  // One flag sets the first three.
  [[maybe_unused]] auto& [kind, color, background_file, shadow_catcher] = background;
  view.add({.name = "background",
            .unit = "scene|transparent|r,g,b|FILE",
            .help =
                "Behind the scene the camera sees its environment, nothing (the picture has an alpha), one "
                "radiance or a picture; so it does through holes and panes, while mirrors and solid glass "
                "show the environment",
            .value = [&background] { return background_value(background); },
            .read = [&background](const std::string& text) { read_background(background, text); }});
  view.add(any_word("shadow-catcher", shadow_catcher, "NODE",
                    "With --background: an object of the file that is not seen, but the shadows on it are"))
      .value = [&background] {
    return background.shadow_catcher.empty() ? OptionValue() : background.shadow_catcher;
  };
  add(number("environment-rotation", rotation_degrees, kAnyFloat, "DEGREES",
             "Turns the environment about +y, counter-clockwise from above"));
  add(number("environment-scale", scale, kNotNegative, "X", "Multiplies the environment"));
}

Option integrator_option(Integrator& integrator, bool& choose) {
  constexpr const char* kAuto = "auto";
  const auto value = [&]() -> OptionValue { return choose ? kAuto : word(integrator); };
  const auto read = [&](const std::string& text) {
    choose = text == kAuto;
    integrator = choose ? Integrator::nrc : parse_choice("--integrator", text, kWords<Integrator>);
  };
  return {.name = "integrator",
          .unit = fmt::format("{}|{}", choice_names(kWords<Integrator>), kAuto),
          .help =
              "What is rendered: radiance (path) or ambient occlusion (ao), or the same with a cache that is "
              "trained first (nrc, nao); auto, that of the presets: nrc, or path where light paths are too "
              "short for a cache to pay",
          .value = value,
          .read = read};
}

constexpr Need kDenoiser{
    [](const RenderOptions& o) { return o.denoise.denoiser != DenoiserKind::none; },
    "--denoiser oidn or auto",
};

constexpr Need kDenoiserOrLayers{
    [](const RenderOptions& o) {
      return o.denoise.denoiser != DenoiserKind::none || has(o.aovs, Aov::denoising);
    },
    "--denoiser oidn or auto, or --aov denoising",
};

void add_denoise_options(OptionGroup& picture, DenoiseOptions& options) {
  auto& [denoiser, prefilter, supersampling, library] = options;
  picture.add(
      choice("denoiser", denoiser,
             "Takes the noise out of the finished picture: Open Image Denoise (oidn), the same where it "
             "is found (auto, that of the presets), or nothing"));
  picture.add(
      choice(
          "prefilter", prefilter,
          "Albedo and normal before they guide the denoiser: denoised themselves (accurate); read as they "
          "are, for half the time (none): what they have of noise shows, in glass and behind lenses; or read "
          "by a smaller network that expects noise in them, for a third of the time (fast)"),
      {kDenoiserOrLayers});
  picture.add(choice("supersampling", supersampling, kSupersampling,
                     "Render and denoise at this many times the width and height, with the same number of "
                     "samples, and scale by the pixel filter: better edges of bright windows, worse fine "
                     "textures, four times the denoiser's time"),
              {kDenoiser});
  picture.add(
      decides_nothing(any_word("oidn", library, "FILE|FOLDER",
                               "Open Image Denoise 2, libOpenImageDenoise.so.2 (default: GATELIGHT_OIDN "
                               "of the environment, else where scripts/setup or the system have it)"),
                      InRecipe::unless_reproducible),
      {kDenoiser});
}

/// Checkpoints store the chosen instruction sets separately.
void add_machine_options(std::vector<Option>& table, int& threads, std::size_t& memory_limit_bytes,
                         std::string& isa) {
  OptionGroup machine{table, "Machine"};
  machine.add(decides_nothing(
      number("threads", threads, {0, 1024}, "N", "0: as many as the machine and the control group allow"),
      InRecipe::unless_reproducible));
  const auto read_limit = [&](const std::string& text) {
    memory_limit_bytes = static_cast<std::size_t>(parse_integer("--memory-limit", text, kMebibytes)) << 20;
  };
  machine.add(decides_nothing({.name = "memory-limit",
                               .unit = "MIB",
                               .help = "Largest memory, in MiB; more is refused; 0: no limit",
                               .value = [&] { return value_of(memory_limit_bytes >> 20); },
                               .read = read_limit},
                              InRecipe::unless_reproducible));
  machine.add(
      decides_nothing(choice("isa", isa, kIsa, "Instruction set of ray tracing, shading and the cache")));
}

}  // namespace

std::vector<Option> option_table(RenderOptions& options) {
  auto& [integrator, choose_integrator, width, height, region, spp, spp_of_paths, time_limit_seconds,
         max_error, max_depth, min_depth, seed, threads, sampler, filter, filter_width, mis, direct,
         light_selection, glass_shadows, watertight, clamp, ao_distance, denoise, aovs, cryptomattes,
         light_groups, nan_policy, memory_limit_bytes, isa, camera, environment, background, cache,
         checkpoint] = options;
  std::vector<Option> table;
  add_checkpoint_options(table, checkpoint);
  add_cache_file_options(table, cache);

  OptionGroup picture{table, "Picture"};
  picture.add(size_option(width, height));
  picture.add(region_option(region));
  picture.add(decides_nothing(number("spp", spp, {1, kOpenSpp}, "N",
                                     "Samples per pixel; at most so many with --time-limit or --max-error")));
  picture.add(decides_nothing(
      number("time-limit", time_limit_seconds, kNotNegative, "SECONDS",
             "Time of scouting, training, rendering and denoising together; it decides --spp and the "
             "steps of a preset where they are not given; loading, building and writing come on top; 0: no "
             "limit")));
  picture.add(decides_nothing(number(
      "max-error", max_error, kNotNegative, "E",
      "Stop where the estimated error of the picture is at most this, as 0.05: relative RMS, the "
      "square root of compare's rel_mse, without the bias of a cache; without --spp at 65536 samples at "
      "the latest; 0: off")));
  picture.add(number("seed", seed, {0, std::numeric_limits<std::uint32_t>::max()}, "N",
                     "Seed of all random numbers"));
  picture.add(choice("sampler", sampler, "Kind of random numbers"));
  picture.add(choice("filter", filter, "Pixel filter"));
  picture.add(number("filter-width", filter_width, {0.0, 32.0}, "PIXELS",
                     "Full width of the pixel filter; 0: the filter's own"));
  add_denoise_options(picture, denoise);
  picture.add(aov_option(aovs));
  picture.add(decides_nothing(cryptomatte_option(cryptomattes)));  // film and checkpoint know nothing of it
  picture.add(light_groups_option(light_groups));

  add_view_options(table, camera, environment, background);

  OptionGroup light{table, "Light transport"};
  light.add(integrator_option(integrator, choose_integrator));
  light.add(number("max-depth", max_depth, kDepth, "N",
                   "Largest number of scattering events; 1: emission and direct light"));
  light.add(number("min-depth", min_depth, kDepth, "N", "Russian roulette starts after this many events"));
  light.add(choice("direct", direct,
                   "How light is found: by light samples (nee), by bounces (bsdf), or by both (mis)"));
  light.add(choice("mis", mis, "Heuristic of multiple importance sampling"));
  light.add(choice("light-selection", light_selection, "How one of many lights is chosen"));
  light.add(choice(
      "glass-shadows", glass_shadows,
      "Light behind glass with an inside: found by bounces alone, so that suns and small lamps give none "
      "(refract), or not bent, as through panes (straight: an approximation, that of the presets)"));
  light.add(
      choice("watertight", watertight, kOnOff,
             "Whether no ray slips between triangles that share an edge; off is faster where triangles are "
             "long and thin"));
  Option& reach = light.add(number("ao-distance", ao_distance,
                                   {.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true},
                                   "METRES", "Reach of ambient occlusion; inf allowed"));
  reach.value = [&options] { return options.ao_distance < 0.0f ? OptionValue() : options.ao_distance; };
  reach.default_text = "a tenth of the scene's diagonal";
  reach.if_none = "auto";
  light.add(number("clamp", clamp, kNotNegative, "X", "Largest luminance of one sample (biased); 0: off"));
  light.add(decides_nothing(choice("nan", nan_policy, "What happens to a sample that is not finite")));

  add_cache_options(table, cache);

  add_machine_options(table, threads, memory_limit_bytes, isa);
  return table;
}

}  // namespace gatelight::renderer
