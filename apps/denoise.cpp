#include <memory>

#include "apps/denoise_run.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/subcommand.h"

namespace gatelight::apps {
namespace {

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
            return denoise(*settings);
          }};
}

}  // namespace gatelight::apps
