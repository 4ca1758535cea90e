#include "apps/settings/option_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "apps/settings/list_value.h"
#include "apps/settings/picture_options.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

/// Beyond this 2^EV leaves the range of float.
constexpr RealRange kStops{-100.0, 100.0};
/// Before the first key and after the last one nothing moves.
constexpr RealRange kSeconds{-1e9, 1e9};
constexpr IntegerRange kTurns{0, 1 << 20};
constexpr IntegerRange kGroups{1, 1 << 20};
constexpr IntegerRange kScenes{-1, 1 << 30};
constexpr RealRange kKelvin{1667.0, 25000.0};
constexpr Choice<int> kBits[] = {{"8", 8}, {"16", 16}};
constexpr Choice<bool> kExr[] = {{"half", false}, {"float", true}};
constexpr Choice<scene::BackFaces> kBackFaces[] = {
    {"show", scene::BackFaces::show}, {"cull", scene::BackFaces::cull}, {"light", scene::BackFaces::light}};
constexpr Choice<bool> kMissing[] = {{"error", true}, {"warn", false}};
constexpr Choice<ProgressMode> kProgressModes[] = {{"auto", ProgressMode::automatic},
                                                   {"bar", ProgressMode::bar},
                                                   {"json", ProgressMode::json},
                                                   {"none", ProgressMode::none}};

/// Options of the call, which do not change its results.
void add_call_options(OptionGroup& group, RenderSettings& settings) {
  auto& [scene, outputs, render, load, frames, image, exposure, eye, target, up, view_file, config, stats,
         skip_existing, progress, reproducible, quiet, verbose, preset, given] = settings;
  const auto add = [&](Option option, Marks marks = {}) {
    marks.in_sweep = false;
    marks.in_recipe = InRecipe::never;
    group.add(std::move(option), std::move(marks));
  };
  add(toggle("skip-existing", skip_existing, "Skip frames and cameras whose pictures already exist"),
      {.stage = OptionStage::program});
  add(toggle("reproducible", reproducible,
             "Omit times, threads and the command line from the EXR header, so that equal renders give equal "
             "files"));
  add(any_word("stats", stats, "FILE|-", "Write statistics as JSON; - is stdout"), {.common = true});
  add(progress_option(progress), {.common = true});
  add(toggle("quiet", quiet, "Print errors only"), {.common = true});
  add(toggle("verbose", verbose, "Also print what was loaded, the memory needed and all options"));
}

/// A part of the view of --eye. Recipes have the complete view.
Option by_hand(const char* name, std::optional<std::array<float, 3>>& member,
               const renderer::CameraOptions& camera, Vec3 LookAt::*part, const char* help) {
  const auto value = [&camera, part](const auto&) -> OptionValue {
    if (!camera.look_at) return {};
    const Vec3& v = (*camera.look_at).*part;
    return std::vector<float>{v.x(), v.y(), v.z()};
  };
  const auto read = [](const std::string& option, const std::string& text) {
    return parse_triple(option, text, kAnyFloat);
  };
  return read_by(name, member, "x,y,z", help, value, read);
}

void add_load_options(OptionGroup& group, scene::LoadOptions& load) {
  // All transforms are baked; --shutter and --threads of the picture set the other two.
  [[maybe_unused]] auto& [scene, variant, time, shutter, animation, missing_is_error, allow_external, ignored,
                          show_hidden, back_faces, lights, profiles, visibility, light_links, bake_transforms,
                          threads] = load;
  const auto add = [&](Option option, Marks marks = {}) -> Option& {
    marks.stage = OptionStage::load;
    return group.add(std::move(option), std::move(marks));
  };
  add(number("scene-index", scene, kScenes, "N", "Index of a scene in the file; -1: the file's default"));
  add(any_word("variant", variant, "NAME", "Material variant of the file, by name"), {.common = true}).value =
      [&load] { return load.variant; };
  add(number_or("", "time", time, kSeconds, "SECONDS",
                "Time at which to show the file's animations; without it, nodes keep their static pose"),
      {.common = true, .in_window = true});
  add(any_word("animation", animation, "NAME|INDEX|none",
               "Animation to show (default: all; if several animate the same value, only the first does)"),
      {.in_window = true});
  add(toggle("show-hidden", show_hidden, "Show nodes that the file hides (KHR_node_visibility)"));
  add(choice("backfaces", back_faces, kBackFaces,
             "Back faces of materials that are not doubleSided: they reflect but do not emit (show), let "
             "rays pass as glTF specifies (cull), or reflect and emit (light). With cull, one-sided walls "
             "are invisible from behind"));
  add(read_by("lights", lights, "NAME=off|X|r,g,b;...",
              "Switch off or multiply lights and emissive materials of the file, by name: \"*=off;lamp=2\". "
              "A '*' at the end of a name matches any ending; for each light, the last match applies",
              list_value, read_lights),
      {.in_window = true});
  add(read_by(
      "ies", profiles, "NAME=FILE;...",
      "IES profiles (LM-63, type C) for point and spot lights of the file, by name as in --lights. The light "
      "points along its node's -z, keeps its intensity in the brightest direction, and loses its cone",
      list_value, read_profiles));
  add(read_by(
          "visibility", visibility, "NAME=RAYS:on|off|only,...;...",
          "Which rays see objects, lamps of the file and the environment, by name as in --lights: "
          "\"wall*=camera:off;decoy=shadow:only;environment=camera:off\". RAYS: camera, diffuse, glossy, "
          "reflections (both), transmission, volume, bounces (these four), shadow; or holdout (on or off), "
          "which leaves a black hole with alpha 0",
          list_value, read_visibility),
      {.in_window = true});
  add(read_by(
          "light-links", light_links, "LIGHT=receivers:NODE+NODE,blockers:NODE;...",
          "Which objects a light or emissive material of the file, or the environment, lights (receivers, "
          "or all but not-receivers), and which cast shadows in its light (blockers, not-blockers): "
          "\"key=receivers:hero*+floor;sun=not-blockers:glass*;environment=blockers:wall\"",
          list_value, read_light_links),
      {.in_window = true});
  add(choice("missing", missing_is_error, kMissing,
             "Whether an unreadable texture is an error or a warning"));
  add(external_option(allow_external));
  add(read_by(
      "ignore-required", ignored, "NAME,...",
      "Load the file although it requires these unsupported glTF extensions, and ignore them",
      [](const std::vector<std::string>& names) -> OptionValue {
        return names.empty() ? OptionValue() : fmt::format("{}", fmt::join(names, ","));
      },
      split_list));
}

void add_frame_options(OptionGroup& group, FrameSettings& frames) {
  auto& [range, fps, turntable, shutter, groups] = frames;
  const auto add = [&](Option option, Marks marks = {}) {
    const auto value = std::move(option.value);
    option.value = [value, &chosen = frames.range]() -> OptionValue {
      return chosen ? value() : OptionValue();
    };
    marks.in_sweep = false;
    group.add(std::move(option), std::move(marks));
  };
  add(read_by(
          "frames", range, "A:B[:STEP]",
          "Frames, or a list such as 1,3,5-9; -o contains %04d, #### or {frame} for the number",
          [](const std::optional<FrameList>& chosen) { return text_of(*chosen); }, parse_frames),
      {.common = true});
  add(read_by(
      "fps", fps, "N",
      "Frames per second: frame n shows the time n / N. Fractions such as 30000/1001 are allowed",
      [](double chosen) { return chosen; }, parse_fps));
  add(number("turntable", turntable, kTurns, "N",
             "Move the camera once around its target in N frames; without --frames, render these N frames"));
  group.add(read_by(
                "shutter", shutter, "OPEN:CLOSE",
                "Motion blur: the shutter opens OPEN frames (of --fps) after the time of a frame and closes "
                "CLOSE frames after it; -0.25:0.25 is a 180-degree shutter",
                [](const ShutterRange& chosen) { return chosen.is_open() ? text_of(chosen) : OptionValue(); },
                parse_shutter),
            {.in_sweep = false});
  group.add(number("frame-groups", groups, kGroups, "N",
                   "Number of groups that split the ranks of gatelight-mpi; each group renders every N-th "
                   "frame. Frames must not depend on each other"),
            {.in_sweep = false, .stage = OptionStage::program, .in_recipe = InRecipe::never});
}

void add_preset(OptionGroup& group, std::optional<CachePreset>& preset) {
  group.add(read_by(
                "preset", preset, choice_names(kEnumNames<CachePreset>),
                "Sets many flags, which other flags override. bare: the cache's answers only; preview, "
                "standard, final: finished pictures in seconds, with little grain, or of final quality; "
                "paper-nao, paper-nrc: the settings of the GATE paper, including size and samples",
                [](const auto& chosen) { return chosen ? enum_name(*chosen) : OptionValue(); },
                [](const std::string& option, const std::string& text) {
                  return parse_choice(option, text, kEnumNames<CachePreset>);
                }),
            {.common = true, .in_recipe = InRecipe::unless_reproducible});
}

/// The options of files with pictures. `stops` sets the exposure.
void add_picture_files(OptionGroup& group, std::vector<std::string>& outputs,
                       renderer::ImageWriteOptions& image, std::optional<float>& stops) {
  auto& [exr_float, bits, display, edited] = image;          // `edited` is no option
  auto& [exposure, white_balance, tonemap, ocio] = display;  // `stops` sets the exposure
  auto& [ocio_config, ocio_display, ocio_view] = ocio;
  Option& output = group.add(any_words("output", outputs, "FILE|-",
                                       "Picture to write: .exr, .png, .jpg, .tif or .hdr; may be given "
                                       "several times. - writes PNG to stdout; exr:- writes EXR, and so on"),
                             {.common = true, .in_sweep = false, .in_recipe = InRecipe::unless_reproducible});
  output.letter = "-o";
  output.required = true;
  const auto add = [&](Option option, Marks marks) {
    marks.stage = OptionStage::output;
    group.add(std::move(option), std::move(marks));
  };
  const std::vector<ImageFormat> shown = {ImageFormat::png, ImageFormat::jpeg, ImageFormat::tiff};
  add(choice("exr", exr_float, kExr, "Precision of colours in EXR files"),
      {.in_sweep = false, .formats = {ImageFormat::exr}});
  add(number_or("auto", "exposure", stops, kStops, "EV",
                "Exposure of PNG, JPEG and TIFF pictures in stops; auto (default of the presets that render "
                "radiance): from the picture's own brightness, printed at the end"),
      {.common = true, .in_window = true, .formats = shown});
  add(number("white-balance", white_balance, kKelvin, "KELVIN",
             "Colour temperature that PNG, JPEG and TIFF pictures show as white"),
      {.in_window = true, .in_sweep = false, .formats = shown});
  add(choice("tonemap", tonemap,
             "Tone curve of PNG, JPEG and TIFF pictures; preview, standard and final use agx"),
      {.common = true, .in_window = true, .formats = shown});
  add(choice("bits", bits, kBits, "Bits per channel of PNG and TIFF files"),
      {.in_sweep = false, .formats = {ImageFormat::png, ImageFormat::tiff}});
  const Marks of_ocio = {.in_sweep = false, .formats = shown};
  add(any_word(
          "ocio", ocio_config, "FILE",
          "OpenColorIO configuration; its view replaces --tonemap and sRGB in PNG, JPEG and TIFF pictures"),
      of_ocio);
  add(any_word("ocio-display", ocio_display, "NAME",
               "Display of the OpenColorIO configuration (default: the configuration's)"),
      of_ocio);
  add(any_word("ocio-view", ocio_view, "NAME", "View of this display (default: the display's)"), of_ocio);
}

}  // namespace

Option external_option(bool& allowed) {
  return toggle("allow-external", allowed,
                "Let the scene read files outside its folder; use it only for scenes that you trust");
}

Option progress_option(ProgressMode& mode) {
  return choice("progress", mode, kProgressModes, "Progress on stderr; auto: a bar if stderr is a terminal");
}

Option positional(const char* name, std::string& member, const char* help) {
  Option option = any_word(name, member, "", help);
  option.positional = option.required = true;
  option.marks.in_recipe = InRecipe::never;
  return option;
}

std::vector<Option> option_table(RenderSettings& settings) {
  // --config belongs to all subcommands.
  auto& [scene, outputs, render, load, frames, image, exposure, eye, target, up, view_file, config, stats,
         skip_existing, progress, reproducible, quiet, verbose, preset, given] = settings;
  std::vector<Option> table;
  table.push_back(positional("SCENE", scene, "Scene, .gltf or .glb"));
  OptionGroup output{table, "Output"};
  add_picture_files(output, outputs, image, exposure);
  add_call_options(output, settings);
  OptionGroup view{table, "Scene and view"}, light{table, "Light transport"};
  for (Option& option : picture_options(render)) {
    const std::string name = option.name;
    table.push_back(std::move(option));
    if (name == "integrator") add_preset(light, preset);
    if (name == "environment-scale") {
      add_load_options(view, load);
      add_frame_options(view, frames);
    }
    if (name != "camera") continue;
    const auto& camera = render.camera;
    const Marks common = {.common = true, .of_view = true, .excludes = {"camera"}};
    view.add(by_hand("eye", eye, camera, &LookAt::eye, "Camera position, in metres (with --target)"), common);
    view.add(by_hand("target", target, camera, &LookAt::target, "Point that the camera looks at, in metres"),
             common);
    view.add(by_hand("up", up, camera, &LookAt::up, "Up direction with --eye"),
             {.of_view = true, .excludes = {"camera"}})
        .default_text = "0,1,0";
    view.add(any_word("view-file", view_file, "FILE",
                      "JSON object with the view: camera, eye, target, up, fov, lens, projection, "
                      "view-height, aperture, focus, blades; flags override it"),
             {.in_recipe = InRecipe::never});
  }
  return table;
}

std::set<std::string> option_names(const std::function<bool(const Option&)>& fits) {
  RenderSettings settings;
  std::set<std::string> names;
  for (const Option& option : option_table(settings)) {
    if (!option.positional && fits(option)) names.insert(option.name);
  }
  return names;
}

std::vector<Option> cache_report_table(RenderSettings& settings) {
  const std::vector<Option> table = option_table(settings);
  std::vector<Option> chosen;
  const auto add = [&](const auto& wanted) {
    std::copy_if(table.begin(), table.end(), std::back_inserter(chosen), wanted);
  };
  const auto named = [&](const std::string& name) { add([&](const Option& o) { return o.name == name; }); };
  named("integrator");
  named("preset");
  named("size");
  add([](const Option& o) { return o.group == "Scene and view"; });
  add([](const Option& o) { return o.group.starts_with("Cache"); });
  named("threads");
  return chosen;
}

}  // namespace gatelight::apps
