#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/job/finished_picture.h"
#include "apps/job/frame_settings.h"
#include "apps/job/sequence_exposure.h"
#include "apps/reports/picture_warnings.h"
#include "apps/reports/recipe.h"
#include "apps/settings/file_names.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/render_settings.h"
#include "apps/settings/unused_flags.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/clock.h"
#include "base/platform/threads.h"
#include "renderer/denoise/denoising_layers.h"
#include "renderer/denoise/layers_to_denoise.h"
#include "renderer/driver/denoise_picture.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_read.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::LayersToDenoise;

constexpr const char* kDenoiseFooter =
    R"(Removes noise with Open Image Denoise. For a picture that was rendered with --aov denoising, the result equals denoising
in the renderer, with its background, exposure and curve unless flags override them. Merged parts (gatelight merge) give
one finished picture.

Layers of other renderers are found by their usual names, in upper or lower case (Blender: "Noisy Image", "Denoising
Albedo", "Denoising Normal"). Albedo or normal alone is also a guide; without any guide, only the colours are denoised.
Each view layer with colours and a guide is denoised; if none has a guide, only the displayed picture is. The summary
lists the layers used. An EXR output is a copy of the input with denoised colours: layers, channel types, windows, parts
and attributes stay unchanged; with --exr float, the colours become floats. In an input with several parts, only parts
with the pixels of the first one are read.

If INPUT and --output contain a place for a frame number, frames are denoised: those of --frames, or all that exist.

Examples:
  gatelight render room.glb -o samples.exr --spp 64 --aov denoising
  gatelight denoise samples.exr -o finished.exr -o finished.png
  gatelight denoise blender.exr -o finished.exr --normal-layer ViewLayer.Normal
  gatelight denoise in-%04d.exr -o out-%04d.exr)";

struct DenoiseSettings : RenderSettings {
  /// The scene is the picture, with the place of a frame's number in its name for frames: those of the range,
  /// else those that exist. The picture's recipe does not override what is given.
  DenoiseSettings() { exposure.reset(); }

  renderer::LayerNames layers;
};

/// Sets the options of finishing the picture from its recipe, where no flag sets them.
void apply_recipe(const renderer::Picture& picture, DenoiseSettings& settings) {
  const ordered_json recipe = recipe_options(picture);
  if (!recipe.is_object()) return;
  for (const Option& option : option_table(settings)) {
    const bool shows =
        option.name == "exposure" || option.name == "tonemap" || option.name == "white-balance";
    if (!shows && (!option.marks.of_denoise || option.marks.in_recipe != InRecipe::always)) continue;
    if (settings.given.contains(option.name) || !recipe.contains(option.name)) continue;
    try {
      option.read(flag_text(recipe[option.name]));
    } catch (const BadOption& error) {
      throw InputError(fmt::format("the recipe of '{}': {}", settings.scene, error.what()));
    }
  }
}

/// "'ViewLayer.Noisy Image' in 'ViewLayer.Combined', with 'ViewLayer.Denoising Normal'"
std::string text_of_layers(const LayersToDenoise& layers) {
  const auto name = [](const std::string& layer) {
    return layer.empty() ? "the picture" : "'" + layer + "'";
  };
  std::string text = name(layers.color);
  if (layers.color != layers.result) text += " in " + name(layers.result);
  if (!layers.has_guides()) return text + ", without guides";
  text += ", with " + name(layers.albedo ? *layers.albedo : *layers.normal);
  if (layers.albedo && layers.normal) text += " and " + name(*layers.normal);
  return text;
}

/// What was denoised, of a picture whose layers are of other programs.
std::string text_of_choice(const renderer::Picture& picture, const std::vector<LayersToDenoise>& layers) {
  std::string text;
  for (const LayersToDenoise& some : layers) {
    if (!some.own) text += fmt::format("denoised  {}\n", text_of_layers(some));
  }
  const std::vector<std::string> left = renderer::colors_left(picture, layers);
  if (!text.empty() && !left.empty())
    text += fmt::format("left      '{}', without guides or not named\n", fmt::join(left, "', '"));
  return text;
}

/// The numbers of frames whose files exist, in their order.
std::vector<int> existing_frames(const std::string& name) {
  namespace fs = std::filesystem;
  std::set<int> frames;
  std::error_code error;
  const fs::path folder = fs::path(name).parent_path();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string file = entry.path().filename().string();
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    for (auto at = file.begin(); at != file.end();) {
      at = std::find_if(at, file.end(), is_digit);
      const auto end = std::find_if_not(at, file.end(), is_digit);
      constexpr std::ptrdiff_t kMaxDigits = 8;
      if (at != end && end - at <= kMaxDigits) {
        for (const int sign : {1, -1}) {
          const int frame = sign * std::stoi(std::string(at, end));
          if (fs::path(name_of_frame(name, frame)).filename() == file) frames.insert(frame);
        }
      }
      at = end;
    }
  }
  return {frames.begin(), frames.end()};
}

/// One picture, or frames of an animation.
class DenoiseRun {
 public:
  explicit DenoiseRun(const DenoiseSettings& settings)
      : whole_(settings), progress_(settings.quiet ? ProgressMode::none : settings.progress, 1.0) {}

  int run() {
    check();
    install_signal_handlers();
    const std::string place = oidn_place(whole_.render.denoise.library);
    const renderer::OidnLibrary& oidn = renderer::load_oidn(place);
    const int threads = whole_.render.threads > 0 ? whole_.render.threads : available_threads();
    require_threads(threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    renderer::Denoiser denoiser(oidn, threads, whole_.render.memory_limit_bytes);
    name_ = fmt::format("Open Image Denoise {}", oidn.version);
    if (!frames_.empty()) choose_exposure();
    const std::vector<DenoiseSettings> all = pictures();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!frames_.empty()) progress_.begin_frame(frames_[i], i, all.size());
      if (!finish(all[i], denoiser, arena)) {
        progress_.clear();
        const std::string done = frames_.empty() ? "nothing was written"
                                                 : fmt::format("{} of {} frames were written", i, all.size());
        print_notice(fmt::format("stopped by signal {}; {}", stop_signal(), done),
                     kSignalBase + stop_signal());
        return kSignalBase + stop_signal();
      }
    }
    progress_.clear();
    report();
    return kDone;
  }

 private:
  void check() {
    if (renderer::image_format(whole_.scene) != renderer::ImageFormat::exr)
      throw BadOption({"INPUT", whole_.scene, "", "an .exr file"});
    if (whole_.frames.range || has_frame_place(whole_.scene)) find_frames();
    check_stdout(whole_.outputs);
    FileNames names;
    const std::vector<DenoiseSettings> all = pictures();
    for (const DenoiseSettings& picture : all) names.read("INPUT", picture.scene);
    for (const std::string& output : whole_.outputs)
      frames_.empty() ? refuse_frame_place("output", output) : require_frame_place("output", output);
    for (const DenoiseSettings& picture : all) {
      for (const std::string& output : picture.outputs) names.write("output", output);
    }
    for (const std::string& output : all.front().outputs) check_picture_output(output);
    check_display(whole_.image.display);
  }

  /// The frames, of which each has its file.
  void find_frames() {
    require_frame_place("INPUT", whole_.scene);
    frames_ = whole_.frames.range ? whole_.frames.range->numbers() : existing_frames(whole_.scene);
    if (frames_.empty())
      throw InputError(fmt::format("cannot read '{}': there is no such file", whole_.scene));
    for (const int frame : frames_) {
      const std::string file = name_of_frame(whole_.scene, frame);
      if (std::error_code error; !std::filesystem::exists(file, error))
        throw InputError(fmt::format("cannot read '{}': there is no such file", file));
    }
  }

  DenoiseSettings settings_of(int frame) const {
    DenoiseSettings settings = whole_;
    settings.scene = name_of_frame(whole_.scene, frame);
    for (std::string& output : settings.outputs) output = name_of_frame(output, frame);
    return settings;
  }
  /// The settings of each frame, or of the picture.
  std::vector<DenoiseSettings> pictures() const {
    std::vector<DenoiseSettings> pictures;
    for (const int frame : frames_) pictures.push_back(settings_of(frame));
    if (frames_.empty()) pictures.push_back(whole_);
    return pictures;
  }

  /// One exposure for all frames, by the light of a few.
  void choose_exposure() {
    if (whole_.exposure || !shows_on_a_screen(whole_.outputs)) return;
    std::vector<float> stops;
    for (const int frame : sampled_frames(frames_)) {
      DenoiseSettings settings = settings_of(frame);
      const renderer::Picture picture = read(settings);
      apply_recipe(picture, settings);
      if (settings.exposure) {
        whole_.exposure = settings.exposure;
        return;
      }
      if (const std::optional<float> suitable = renderer::exposure_of_light(picture))
        stops.push_back(*suitable);
    }
    whole_.exposure = common_exposure(stops);
  }

  renderer::Picture read(const DenoiseSettings& settings) const {
    renderer::Picture picture = renderer::read_image(settings.scene);
    const bool has_samples = picture.find("raw") || renderer::has_denoising_layers(picture);
    if (picture.metadata.contains("denoiser") && !has_samples && settings.layers.color.empty())
      throw InputError(fmt::format("'{}' is denoised already, expected the layers of --aov denoising or raw",
                                   settings.scene));
    return picture;
  }

  /// Denoises and writes one picture. False where a signal stopped it.
  bool finish(DenoiseSettings settings, renderer::Denoiser& denoiser, tbb::task_arena& arena) {
    progress_.phase("load");
    renderer::Picture picture = read(settings);
    apply_recipe(picture, settings);
    const renderer::RenderOptions& o = settings.render;
    try {
      const std::vector<LayersToDenoise> layers = renderer::layers_to_denoise(picture, settings.layers);
      choice_ = text_of_choice(picture, layers);
      std::optional<renderer::Picture> denoised = arena.execute([&] {
        return denoise_picture(std::move(picture), layers, denoiser,
                               {o.denoise.prefilter, o.filter, o.filter_width, o.background}, progress());
      });
      if (!denoised) return false;
      denoised->metadata["denoiser"] = name_;
      settings.image.edited = edited_exr(settings.scene, *denoised, layers);
      arena.execute([&] { write(*denoised, settings); });
    } catch (const InputError& error) {
      throw InputError(fmt::format("'{}' {}", settings.scene, error.what()));
    }
    return true;
  }

  renderer::DenoiseProgress progress() {
    return [this](double done) {
      progress_.update(
          {.phase = renderer::Phase::denoise, .fraction = done, .seconds = seconds_since(start_)});
      return stop_signal() == 0;
    };
  }

  void write(const renderer::Picture& picture, DenoiseSettings& settings) const {
    settings.image.display.exposure =
        settings.exposure ? *settings.exposure : renderer::auto_exposure(picture);
    if (const std::string text = overflow_warning(picture, settings.outputs, settings.image);
        !text.empty() && !settings.quiet)
      log_warning(text);
    write_pictures(picture, settings.outputs, settings.image);
  }

  void report() const {
    if (whole_.quiet) return;
    const std::string frames = frames_.empty() ? "" : fmt::format(", {} frames", frames_.size());
    print_status(fmt::format("{}written   {}{}\nseconds   {:.2f}, by {}\n", choice_,
                             fmt::join(whole_.outputs, ", "), frames, seconds_since(start_), name_));
  }

  DenoiseSettings whole_;
  std::vector<int> frames_;  ///< empty: a single picture
  std::string name_, choice_;
  Clock::time_point start_ = Clock::now();
  ProgressReporter progress_;
};

bool is_of_denoise(const Option& option) {
  return option.marks.of_denoise || option.marks.stage == OptionStage::output || option.name == "output" ||
         option.name == "progress" || option.name == "quiet";
}

std::vector<Option> denoise_table(DenoiseSettings& settings) {
  std::vector<Option> table = option_table(settings);
  std::erase_if(table, [](const Option& option) { return !is_of_denoise(option); });
  table.push_back(
      positional("INPUT", settings.scene, "Picture, .exr; with %04d, #### or {frame} in its name: frames"));
  OptionGroup input{table, "Layers of the input"};
  input.add(read_by(
      "frames", settings.frames.range, "A:B[:STEP]", "Frames to denoise (default: all that exist)",
      [](const auto&) { return OptionValue(); }, parse_frames));
  const auto add_layer = [&](const char* name, std::string& member, const char* help) {
    input.add(any_word(name, member, "NAME", help));
  };
  add_layer("color-layer", settings.layers.color,
            "Layer with the noisy colours, which are replaced (default: found by its usual names)");
  add_layer("albedo-layer", settings.layers.albedo,
            "Layer with the albedo of visible surfaces, or none (default: found by its usual names)");
  add_layer("normal-layer", settings.layers.normal,
            "Layer with the normals of visible surfaces, or none (default: found by its usual names)");
  return table;
}

}  // namespace

Subcommand add_denoise_command(CLI::App& root) {
  CLI::App* app = add_subcommand(root, "denoise", "Remove the noise of a picture", kDenoiseFooter);
  const auto settings = std::make_shared<DenoiseSettings>();
  add_flags(*app, denoise_table(*settings));
  return {.app = app, .run = [app, settings] {
            const std::vector<std::string> given = given_names(*app);
            settings->given = {given.begin(), given.end()};
            return DenoiseRun(*settings).run();
          }};
}

}  // namespace gatelight::apps
