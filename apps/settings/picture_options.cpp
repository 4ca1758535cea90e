#include "apps/settings/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "apps/settings/list_value.h"
#include "apps/settings/parsing.h"
#include "base/errors.h"

// Structured bindings name every member of the structs: a new member does not compile until it is described
// here.

namespace gatelight::apps {
namespace {

using namespace renderer;

constexpr IntegerRange kDepth{0, 65536};
constexpr IntegerRange kMebibytes{0, std::int64_t{1} << 40};
constexpr Choice<std::string_view> kIsa[] = {
    {"auto", "auto"}, {"scalar", "scalar"}, {"avx2", "avx2"}, {"avx512", "avx512"}};

constexpr Choice<int> kSupersampling[] = {{"1", 1}, {"2", 2}};

/// Words that stand for several values.
template <class Enumeration>
using Words = std::map<std::string, std::vector<Enumeration>>;

/// Values by a list of names, each once, in the order of the enumeration.
template <class Enumeration>
std::vector<Enumeration> read_words(const std::string& option, const std::string& text,
                                    const Words<Enumeration>& words = {}) {
  std::vector<Enumeration> values;
  for (const std::string& word : split_list(option, text)) {
    if (const auto several = words.find(word); several != words.end()) {
      values.insert(values.end(), several->second.begin(), several->second.end());
    } else {
      values.push_back(parse_choice(option, word, kEnumNames<Enumeration>));
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

template <class Enumeration>
OptionValue words_of(const std::vector<Enumeration>& values) {
  std::vector<std::string> words;
  for (const Enumeration value : values) words.push_back(enum_name(value));
  return words;
}

void add_checkpoint_options(std::vector<Option>& table, CheckpointOptions& checkpoint) {
  auto& [file, every_seconds, resume] = checkpoint;
  OptionGroup files{table, "Files"};
  const auto add = [&](Option option, Marks marks = {}) {
    option.default_text = option.text();
    option.value = [&checkpoint, value = option.value] {
      return checkpoint.file.empty() ? OptionValue() : value();
    };
    marks.in_sweep = false;
    marks.in_recipe = InRecipe::unless_reproducible;
    files.add(std::move(option), std::move(marks));
  };
  add(any_word("checkpoint", file, "FILE", "Write a checkpoint, from which --resume continues an ended run"),
      {.common = true});
  add(number("checkpoint-every", every_seconds, kNotNegative, "SECONDS",
             "Interval between writes of the checkpoint"));
  add(toggle("resume", resume, "Continue from the checkpoint if it exists; the picture is bit-identical"),
      {.common = true});
}

Option size_option(int& width, int& height) {
  const auto value = [&]() -> OptionValue { return std::vector<int>{width, height}; };
  const auto read = [&](const std::string& text) {
    const std::array<int, 2> size = parse_size("size", text);
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
  return read_by(
      "region", region, "x0,y0,x1,y1",
      "Render only this part of the picture, in pixels; x1 and y1 are excluded",
      [](const auto& r) { return r ? std::vector<int>(r->begin(), r->end()) : OptionValue(); }, parse_region);
}

Option aov_option(std::vector<Aov>& aovs) {
  std::string help = "Additional EXR layers, separated by commas: ";
  Words<Aov> words;
  for (const AovInfo& row : kAovs) {
    words["all"].push_back(row.aov);
    if (row.source == AovSource::pass) continue;
    const bool plain =
        row.help.empty() || row.needs >= AovNeeds::cache;  // the manual explains those of a cache
    help += plain ? fmt::format("{}, ", row.name) : fmt::format("{} ({}), ", row.name, row.help);
  }
  words["passes"] = all_passes();
  help += "passes (light in parts), all";
  return read_by("aov", aovs, "LIST", help, words_of<Aov>,
                 [words](const std::string& option, const std::string& text) {
                   return read_words(option, text, words);
                 });
}

Option cryptomatte_option(std::vector<MatteKind>& kinds) {
  return read_by(
      "cryptomatte", kinds, "object,material",
      "Masks for compositing in EXR files (Cryptomatte specification), by the names of objects, materials or "
      "both, six names per pixel. Glass and mirrors are masked themselves, not the objects seen in them",
      [](const auto& chosen) { return chosen.empty() ? OptionValue() : words_of(chosen); },
      [](const std::string& option, const std::string& text) { return read_words<MatteKind>(option, text); });
}

Option light_groups_option(std::vector<LightGroup>& groups) {
  return read_by("light-groups", groups, "none|A=LIGHT,LIGHT;B=...",
                 "EXR layers, light-A and so on, with the light of these lights and emissive materials of "
                 "the file, by name ('*' at the end matches any ending), or of the environment; light-rest "
                 "has all other light. Needs --integrator path. Example: \"key=Sun,Lamp*;sky=environment\"",
                 list_value, read_light_groups);
}

Option integrator_option(Integrator& integrator, bool& choose) {
  constexpr const char* kAuto = "auto";
  const auto value = [&]() -> OptionValue { return choose ? kAuto : enum_name(integrator); };
  const std::string names = fmt::format("{}|{}", choice_names(kEnumNames<Integrator>), kAuto);
  const auto read = [&, names](const std::string& text) {
    choose = text == kAuto;
    integrator = Integrator::nrc;
    if (choose) return;
    const auto& known = kEnumNames<Integrator>;
    const auto chosen =
        std::find_if(std::begin(known), std::end(known), [&](const auto& name) { return name.name == text; });
    if (chosen == std::end(known)) refuse_choice("integrator", text, names);
    integrator = chosen->value;
  };
  return {.name = "integrator",
          .unit = names,
          .help =
              "Radiance (path) or ambient occlusion (ao), or the same with a neural cache that is trained "
              "first (nrc, nao); auto (default of preview, standard and final): nrc, or path if light paths "
              "are too short for a cache to pay off",
          .value = value,
          .read = read};
}

constexpr Requirement kDenoiser{
    [](const RenderOptions& o) { return o.denoise.denoiser != DenoiserKind::none; },
    "`denoiser` oidn or auto",
};

constexpr Requirement kDenoiserOrLayers{
    [](const RenderOptions& o) {
      return o.denoise.denoiser != DenoiserKind::none || has(o.aovs, Aov::denoising);
    },
    "`denoiser` oidn or auto, or `aov` denoising",
};

void add_denoise_options(OptionGroup& picture, DenoiseOptions& options) {
  auto& [denoiser, prefilter, supersampling, temporal, parts, library] = options;
  picture.add(choice("denoiser", denoiser,
                     "Denoise the picture with Open Image Denoise: always (oidn), if it is found (auto, "
                     "default of preview, standard and final), or never (none)"),
              {.common = true});
  picture.add(
      choice("prefilter", prefilter,
             "Treatment of albedo and normal before they guide the denoiser: denoised first (accurate); "
             "unfiltered, in half the time, but their noise shows in glass and with depth of field (none); "
             "or unfiltered for a smaller network that expects noise, in a third of the time (fast)"),
      {.of_denoise = true, .needs = {kDenoiserOrLayers}});
  picture.add(choice("supersampling", supersampling, kSupersampling,
                     "Render and denoise at this multiple of width and height, with the same total of "
                     "samples, and scale with the pixel filter: better edges of bright windows, worse fine "
                     "textures, four times the denoising time"),
              {.needs = {kDenoiser}});
  picture.add(
      choice(
          "temporal", temporal, kOnOff,
          "Before denoising, reuse samples of earlier frames that show the same surface in the same light"),
      {.in_sweep = false, .needs = {kDenoiser}});
  picture.add(choice("denoise-parts", parts, kOnOff,
                     "Also denoise the layers of passes and light groups, and scale them so that they sum to "
                     "the picture. Each layer takes as long as the picture"),
              {.in_sweep = false, .needs = {kDenoiser}, .formats = {ImageFormat::exr}});
  picture.add(any_word("oidn", library, "FILE|FOLDER",
                       "Open Image Denoise 2, libOpenImageDenoise.so.2 (default: the environment variable "
                       "GATELIGHT_OIDN, else the library of scripts/setup or of the system)"),
              {.of_denoise = true, .in_recipe = InRecipe::of_machine, .needs = {kDenoiser}});
}

/// Checkpoints store the chosen instruction sets separately.
void add_machine_options(std::vector<Option>& table, int& threads, std::size_t& memory_limit_bytes,
                         std::string& isa) {
  OptionGroup machine{table, "Machine"};
  const Marks of_machine = {.common = true, .of_denoise = true, .in_recipe = InRecipe::of_machine};
  machine.add(number("threads", threads, {0, 1024}, "N",
                     "Number of threads; 0: as many as machine and control group allow"),
              of_machine);
  machine.add(read_by(
                  "memory-limit", memory_limit_bytes, "MIB",
                  "Memory limit in MiB; renders that need more are refused; 0: no limit",
                  [](std::size_t bytes) { return value_of(bytes >> 20); },
                  [](const std::string& option, const std::string& text) {
                    return static_cast<std::size_t>(parse_integer(option, text, kMebibytes)) << 20;
                  }),
              of_machine);
  machine.add(choice("isa", isa, kIsa, "Instruction set of ray tracing, shading and the cache"),
              {.of_field = true});
}

}  // namespace

std::vector<Option> picture_options(RenderOptions& options) {
  auto& [integrator, choose_integrator, width, height, region, spp, spp_of_paths, time_limit_seconds,
         max_error, max_depth, max_transmission_depth, min_depth, seed, threads, sampler, filter,
         filter_width, mis, direct, light_selection, glass_shadows, watertight, clamp, ao_distance, denoise,
         aovs, cryptomattes, light_groups, nan_policy, memory_limit_bytes, isa, camera, environment,
         background, cache, checkpoint, processes] = options;
  std::vector<Option> table;
  add_checkpoint_options(table, checkpoint);
  add_cache_file_options(table, cache);

  OptionGroup picture{table, "Picture"};
  picture.add(size_option(width, height), {.common = true, .in_window = true});
  picture.add(region_option(region));
  picture.add(number("spp", spp, {1, kUnlimitedSpp}, "N",
                     "Samples per pixel; an upper limit with --time-limit or --max-error"),
              {.common = true, .in_window = true});
  picture.add(
      number("time-limit", time_limit_seconds, kNotNegative, "SECONDS",
             "Total time for scouting, training, rendering and denoising; loading, building and writing are "
             "extra. It decides --spp and the training steps of a preset unless they are given; 0: no limit"),
      {.common = true, .in_sweep = false});
  picture.add(number("max-error", max_error, kNotNegative, "E",
                     "Stop once the estimated error of the picture is at most this, such as 0.05: relative "
                     "RMS, the square root of compare's rel_mse, without the bias of a cache. Unless --spp "
                     "is given, stop after 65536 samples at the latest; 0: off"),
              {.common = true, .in_sweep = false});
  picture.add(
      number("seed", seed, {0, std::numeric_limits<std::uint32_t>::max()}, "N", "Seed of all random numbers"),
      {.common = true, .in_window = true, .of_field = true});
  picture.add(choice(
      "sampler", sampler,
      "A Sobol sequence in each pixel; one for all pixels, whose noise is easier to denoise (screen, "
      "default of preview, standard and final; only without a cache, a time limit and an error limit); or "
      "independent numbers"));
  picture.add(choice("filter", filter, "Pixel filter"), {.of_denoise = true});
  picture.add(number("filter-width", filter_width, {0.0, 32.0}, "PIXELS",
                     "Full width of the pixel filter; 0: the filter's default"),
              {.of_denoise = true});
  add_denoise_options(picture, denoise);
  picture.add(aov_option(aovs), {.common = true, .in_sweep = false, .formats = {ImageFormat::exr}});
  // Film and checkpoint do not store it.
  picture.add(cryptomatte_option(cryptomattes), {.in_sweep = false, .formats = {ImageFormat::exr}});
  picture.add(light_groups_option(light_groups), {.formats = {ImageFormat::exr}});

  add_view_options(table, camera, environment, background);

  OptionGroup light{table, "Light transport"};
  light.add(integrator_option(integrator, choose_integrator), {.common = true});
  light.add(number_or("none", "max-depth", max_depth, kDepth, "N",
                      "Largest number of scattering events; 1: emission and direct light"),
            {.common = true, .in_window = true});
  light.add(number_or("none", "max-transmission-depth", max_transmission_depth, kDepth, "N",
                      "Largest number of transmissions through surfaces; panes do not count"));
  light.add(number("min-depth", min_depth, kDepth, "N",
                   "Number of scattering events before Russian roulette starts"));
  light.add(choice("direct", direct,
                   "How direct light is found: by light samples (nee), by bounces (bsdf), or by both (mis)"));
  light.add(choice("mis", mis, "Heuristic of multiple importance sampling"));
  light.add(choice("light-selection", light_selection, "How a light is selected for a light sample"));
  light.add(choice("glass-shadows", glass_shadows,
                   "Light through solid glass: refracted, but found only by bounces, which miss suns and "
                   "small lamps (refract); or not refracted, as through panes (straight: an approximation, "
                   "default of bare, preview, standard and final)"));
  light.add(
      choice("watertight", watertight,
             "Let no ray slip between triangles that share an edge; off is faster outdoors; auto (default "
             "of preview, standard and final): off unless light behind walls would show"));
  Option& reach = light.add(number("ao-distance", ao_distance,
                                   {.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true},
                                   "METRES", "Reach of ambient occlusion; inf is allowed"));
  reach.value = [&options] { return options.ao_distance < 0.0f ? OptionValue() : options.ao_distance; };
  reach.default_text = "a tenth of the scene's diagonal";
  light.add(number("clamp", clamp, kNotNegative, "X", "Largest luminance of one sample (biased); 0: off"),
            {.common = true, .in_window = true});
  light.add(choice("nan", nan_policy, "Treatment of a sample that is not finite"));

  add_cache_options(table, cache);

  add_machine_options(table, threads, memory_limit_bytes, isa);
  return table;
}

}  // namespace gatelight::apps
