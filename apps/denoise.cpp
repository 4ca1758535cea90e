#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/reports/overflow_warning.h"
#include "apps/reports/recipe.h"
#include "apps/settings/file_names.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_options.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/progress.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/version.h"
#include "base/clock.h"
#include "base/platform/threads.h"
#include "renderer/driver/denoise_picture.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"

namespace gatelight::apps {
namespace {

constexpr const char* kDenoiseFooter =
    R"(Takes the noise out of a picture by Open Image Denoise. A picture that was rendered with --aov denoising gives the
same picture as denoising in the renderer, with its background, exposure and curve, unless flags override them; merged
parts (gatelight merge) give one finished picture. Pictures of other renderers need layers of albedo and normal,
which are found by their usual names (Blender: "Denoising Albedo", "Denoising Normal", "Noisy Image"); without them only
the colours are denoised. Further layers of an EXR, Cryptomattes among them, stay as they are; of an EXR of several
parts those are read that have the pixels of the first.

Examples:
  gatelight render room.glb -o samples.exr --spp 64 --aov denoising
  gatelight denoise samples.exr -o finished.exr -o finished.png
  gatelight denoise blender.exr -o finished.exr --normal-layer ViewLayer.Normal)";

using nlohmann::ordered_json;

struct DenoiseSettings {
  std::string input;
  std::vector<std::string> outputs;
  renderer::ImageWriteOptions image;
  std::optional<float> exposure;
  renderer::RenderOptions render;  ///< only the options of kOfRender are used
  renderer::LayerNames layers;
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;
};

/// The options of `render` that this command has too.
constexpr const char* kOfRender[] = {"background", "filter",  "filter-width", "prefilter",
                                     "oidn",       "threads", "memory-limit"};
/// Options that the picture's recipe sets, unless a flag does.
constexpr const char* kOfRecipe[] = {"prefilter", "filter", "filter-width", "background"};

std::vector<Option> denoise_table(DenoiseSettings& settings) {
  std::vector<Option> table;
  table.push_back(positional("INPUT", settings.input, "Picture, .exr"));
  OptionGroup output{table, "Output"};
  add_picture_files(output, settings.outputs, settings.image, settings.exposure);
  output.add(progress_option(settings.progress));
  output.add(toggle("quiet", settings.quiet, "Print errors only"));
  OptionGroup input{table, "Layers of the input"};
  const auto add_layer = [&](const char* name, std::string& member, const char* help) {
    input.add(any_word(name, member, "NAME", help));
  };
  add_layer("color-layer", settings.layers.color, "Colours with noise (default: by the usual names)");
  add_layer("albedo-layer", settings.layers.albedo,
            "Albedo of the visible surfaces (default: by the usual names)");
  add_layer("normal-layer", settings.layers.normal,
            "Normals of the visible surfaces (default: by the usual names)");
  for (Option& option : picture_options(settings.render)) {
    if (std::find(std::begin(kOfRender), std::end(kOfRender), option.name) != std::end(kOfRender))
      table.push_back(std::move(option));
  }
  return table;
}

/// Text of a recipe's value, in the syntax that the option reads.
std::string text_of(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const ordered_json& part : value) text += (text.empty() ? "" : ",") + part.dump();
  return text;
}

/// Sets the options of finishing the picture from its recipe, where no flag sets them.
void apply_recipe(const renderer::Picture& picture, const std::set<std::string>& given,
                  DenoiseSettings& settings) {
  const ordered_json recipe = recipe_options(picture);
  if (!recipe.is_object()) return;
  const auto read = [&](Option& option) {
    if (given.contains(option.flag()) || !recipe.contains(option.name)) return;
    try {
      option.read(text_of(recipe[option.name]));
    } catch (const BadOption& error) {
      throw InputError(fmt::format("the recipe of '{}': {}", settings.input, error.what()));
    }
  };
  for (Option& option : picture_options(settings.render)) {
    if (std::find(std::begin(kOfRecipe), std::end(kOfRecipe), option.name) != std::end(kOfRecipe))
      read(option);
  }
  std::vector<Option> files;
  OptionGroup group{files, ""};
  std::vector<std::string> outputs;
  add_picture_files(group, outputs, settings.image, settings.exposure);
  for (Option& option : files) {
    if (option.name == "exposure" || option.name == "tonemap" || option.name == "white-balance") read(option);
  }
}

class DenoiseRun {
 public:
  DenoiseRun(DenoiseSettings settings, const std::set<std::string>& given)
      : settings_(std::move(settings)),
        given_(given),
        progress_(settings_.quiet ? ProgressMode::none : settings_.progress, 1.0) {}

  int run() {
    check();
    install_signal_handlers();
    const std::string place = oidn_place(settings_.render.denoise.library);
    const renderer::OidnLibrary& oidn = renderer::load_oidn(place);
    const int threads = settings_.render.threads > 0 ? settings_.render.threads : available_threads();
    require_threads(threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    renderer::Denoiser denoiser(oidn, threads, settings_.render.memory_limit_bytes);
    progress_.phase("load");
    renderer::Picture picture = read();
    apply_recipe(picture, given_, settings_);
    const renderer::Samples samples = samples_in(picture);
    std::optional<renderer::Picture> denoised = arena.execute(
        [&] { return denoise_picture(std::move(picture), samples, denoiser, options_of(), progress()); });
    progress_.clear();
    if (!denoised) {
      print_notice(fmt::format("stopped by signal {}; nothing was written", stop_signal()),
                   kSignalBase + stop_signal());
      return kSignalBase + stop_signal();
    }
    renderer::Picture finished = std::move(*denoised);
    finished.metadata["denoiser"] = fmt::format("Open Image Denoise {}", oidn.version);
    write(finished);
    return kDone;
  }

 private:
  void check() const {
    if (renderer::image_format(settings_.input) != renderer::ImageFormat::exr)
      throw UsageError(fmt::format("denoise: '{}' is not an .exr file", settings_.input));
    FileNames names;
    names.read("INPUT", settings_.input);
    check_stdout(settings_.outputs);
    for (const std::string& output : settings_.outputs) {
      refuse_frame_place("--output", output);
      names.write("--output", output);
      check_picture_output(output);
    }
    check_display(settings_.image.display);
  }

  renderer::Picture read() const {
    renderer::Picture picture = renderer::read_image(settings_.input);
    const bool has_samples = picture.find("raw") ||
                             std::any_of(picture.layers.begin(), picture.layers.end(), [](const auto& layer) {
                               return renderer::is_denoising_layer(layer.name);
                             });
    if (picture.metadata.contains("denoiser") && !has_samples && settings_.layers.color.empty())
      throw InputError(fmt::format("'{}' is denoised already, expected the layers of --aov denoising or raw",
                                   settings_.input));
    return picture;
  }

  renderer::Samples samples_in(const renderer::Picture& picture) const {
    try {
      renderer::Samples samples = renderer::samples_of(picture, settings_.layers);
      using Kind = renderer::BackgroundOptions::Kind;
      const renderer::BackgroundOptions& background = settings_.render.background;
      // The colours already contain the background, with sharp edges of the objects in front of it.
      if (background.is_separate() && background.kind != Kind::transparent && samples.alpha.empty())
        throw InputError(
            "has no samples of its alpha, expected the layers of --aov denoising for a "
            "picture with a background of its own");
      return samples;
    } catch (const InputError& error) {
      throw InputError(fmt::format("'{}' {}", settings_.input, error.what()));
    }
  }

  renderer::DenoisePictureOptions options_of() const {
    const renderer::RenderOptions& o = settings_.render;
    return {o.denoise.prefilter, o.filter, o.filter_width, o.background};
  }

  renderer::DenoiseProgress progress() {
    return [this](double done) {
      progress_.update(
          {.phase = renderer::Phase::denoise, .fraction = done, .seconds = seconds_since(start_)});
      return stop_signal() == 0;
    };
  }

  void write(const renderer::Picture& picture) {
    settings_.image.display.exposure =
        settings_.exposure ? *settings_.exposure : renderer::auto_exposure(picture);
    if (const std::string text = overflow_warning(picture, settings_.outputs, settings_.image);
        !text.empty() && !settings_.quiet)
      log_warning(text);
    std::exception_ptr first_error;
    for (const std::string& output : settings_.outputs) {
      try {
        write_picture(picture, output, settings_.image);
      } catch (...) {
        if (!first_error) first_error = std::current_exception();
      }
    }
    if (first_error) std::rethrow_exception(first_error);
    if (settings_.quiet) return;
    print_status(fmt::format("written   {}\nseconds   {:.2f}, by {}\n", fmt::join(settings_.outputs, ", "),
                             seconds_since(start_), picture.metadata.at("denoiser")));
  }

  DenoiseSettings settings_;
  std::set<std::string> given_;
  Clock::time_point start_ = Clock::now();
  ProgressReporter progress_;
};

}  // namespace

Subcommand add_denoise_command(CLI::App& root) {
  CLI::App* app = add_subcommand(root, "denoise", "Take the noise out of a picture", kDenoiseFooter);
  const auto settings = std::make_shared<DenoiseSettings>();
  const std::vector<Option> options = denoise_table(*settings);
  add_flags(*app, options);
  return {.app = app,
          .run =
              [app, settings] {
                const std::vector<std::string> given = given_flags(*app);
                return DenoiseRun(*settings, {given.begin(), given.end()}).run();
              },
          .options = options};
}

}  // namespace gatelight::apps
