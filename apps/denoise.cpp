#include <algorithm>
#include <memory>
#include <utility>

#include "apps/denoise_run.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_options.h"
#include "apps/subcommand.h"

namespace gatelight::apps {
namespace {

constexpr const char* kDenoiseFooter =
    R"(Takes the noise out of a picture by Open Image Denoise. A picture that was rendered with --aov denoising gives the
same picture as denoising in the renderer, with its background, exposure and curve, unless flags override them; merged
parts (gatelight merge) give one finished picture.

Layers of other renderers are found by their usual names, in any case (Blender: "Noisy Image", "Denoising Albedo",
"Denoising Normal"). Albedo or normal alone is a guide, too; without any, only the colours are denoised. Each view layer
with colours and a guide is denoised; where none has one, only the picture that is shown is. The summary says which.
An EXR is the input with other colours: layers, types of channels, windows, parts and attributes stay as they are; with
--exr float, the colours become floats. Of an input of several parts, those are read that have the pixels of the first.

With the place of a frame's number in INPUT and --output, frames are denoised: those of --frames, or all that there are.

Examples:
  gatelight render room.glb -o samples.exr --spp 64 --aov denoising
  gatelight denoise samples.exr -o finished.exr -o finished.png
  gatelight denoise blender.exr -o finished.exr --normal-layer ViewLayer.Normal
  gatelight denoise in-%04d.exr -o out-%04d.exr)";

std::vector<Option> denoise_table(DenoiseSettings& settings) {
  std::vector<Option> table;
  table.push_back(positional("INPUT", settings.input, "Picture, .exr; %04d, #### or {frame}: frames"));
  OptionGroup output{table, "Output"};
  add_picture_files(output, settings.outputs, settings.image, settings.exposure);
  output.add(progress_option(settings.progress));
  output.add(toggle("quiet", settings.quiet, "Print errors only"));
  OptionGroup input{table, "Layers of the input"};
  input.add(read_by(
      "frames", settings.frames, "A:B[:STEP]", "Frames to denoise (default: all that there are)",
      [](const auto&) { return OptionValue(); },
      [](const std::string& option, const std::string& text) {
        return parse_frames(option, text).numbers();
      }));
  const auto add_layer = [&](const char* name, std::string& member, const char* help) {
    input.add(any_word(name, member, "NAME", help));
  };
  add_layer("color-layer", settings.layers.color,
            "Colours with noise, which are replaced (default: by the usual names)");
  add_layer("albedo-layer", settings.layers.albedo,
            "Albedo of the visible surfaces, or none (default: by the usual names)");
  add_layer("normal-layer", settings.layers.normal,
            "Normals of the visible surfaces, or none (default: by the usual names)");
  for (Option& option : picture_options(settings.render)) {
    if (option.marks.of_denoise) table.push_back(std::move(option));
  }
  return table;
}

}  // namespace

Subcommand add_denoise_command(CLI::App& root) {
  CLI::App* app = add_subcommand(root, "denoise", "Take the noise out of a picture", kDenoiseFooter);
  const auto settings = std::make_shared<DenoiseSettings>();
  add_flags(*app, denoise_table(*settings));
  return {.app = app, .run = [app, settings] {
            const std::vector<std::string> given = given_names(*app);
            return denoise(*settings, {given.begin(), given.end()});
          }};
}

}  // namespace gatelight::apps
