#include "renderer/reconstruction/reconstruct.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/reports/recipe.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/machine/threads.h"

namespace gatelight::apps {
namespace {

constexpr const char* kReconstructFooter =
    R"(Takes the grain out of a picture that was rendered with --aov reconstruction, or merged from such pictures. The samples
are fitted to normals and depth in small windows; where that is not expected to be closer to the truth than the samples
are, their mean is kept. An EXR holds the finished picture, the mean of the samples (layer raw), the estimated standard
error (layer error) and what Cryptomattes there were.

Example:
  gatelight render room.glb -o samples.exr --exr float --spp 16 --aov reconstruction
  gatelight reconstruct samples.exr -o finished.exr)";

struct ReconstructSettings {
  std::string input;
  std::string output;
  int threads = 0;
};

/// The layers hold nothing of a background that was put behind the picture.
void expect_no_background(const renderer::Picture& picture, const std::string& name) {
  const nlohmann::ordered_json options = recipe_options(picture);
  if (options.contains("background") && options["background"] != "scene")
    throw InputError(fmt::format(
        "'{}' has the background {}, which its samples do not hold, expected one that was rendered "
        "with --background scene",
        name, options["background"].dump()));
}

renderer::Picture finish(renderer::Picture picture, const std::string& name) {
  expect_no_background(picture, name);
  renderer::Reconstruction finished;
  try {
    finished = reconstruct(renderer::take_samples(picture));
  } catch (const renderer::ImageError& error) {
    throw InputError(fmt::format("'{}' {}", name, error.what()));
  }
  // Where the picture is a finished one already, its samples' mean is a layer.
  const renderer::Layer* const mean = picture.find("raw");
  renderer::Layer raw = mean ? *mean : picture.layers.front();
  raw.name = "raw";
  // Cryptomattes are not made of samples: they stay as they are.
  std::vector<renderer::Layer> mattes;
  for (renderer::Layer& layer : picture.layers) {
    if (is_cryptomatte(picture, layer.name)) mattes.push_back(std::move(layer));
  }
  picture.layers = {
      {.channels = {"R", "G", "B"}, .values = std::move(finished.color)},
      std::move(raw),
      {.name = "error", .channels = {"R", "G", "B"}, .values = std::move(finished.error)},
  };
  picture.layers.insert(picture.layers.end(), std::move_iterator(mattes.begin()),
                        std::move_iterator(mattes.end()));
  picture.metadata["reconstructed"] = "yes";
  return picture;
}

int run_reconstruct(const ReconstructSettings& settings) {
  if (renderer::image_format(settings.input) != renderer::ImageFormat::exr)
    throw UsageError(fmt::format("reconstruct: '{}' is not an .exr file", settings.input));
  renderer::check_image_output(settings.output);
  const int threads = settings.threads > 0 ? settings.threads : renderer::available_threads();
  renderer::require_threads(threads);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  renderer::write_image(finish(renderer::read_image(settings.input), settings.input), settings.output);
  return kDone;
}

}  // namespace

Subcommand add_reconstruct_command(CLI::App& root) {
  CLI::App* app = add_subcommand(root, "reconstruct", "Take the grain out of a picture", kReconstructFooter);
  const auto settings = std::make_shared<ReconstructSettings>();
  renderer::Option input = renderer::any_word("INPUT", settings->input, "",
                                              "Picture with the layers of --aov reconstruction, .exr");
  input.positional = input.required = true;
  renderer::Option output =
      renderer::any_word("output", settings->output, "FILE", "Picture to write, .exr or .png");
  output.letter = "-o";
  output.required = true;
  renderer::Option threads = renderer::number("threads", settings->threads, {0, 1024}, "N",
                                              "0: as many as the machine and the control group allow");
  add_flags(*app, {output, threads, input});
  return {app, [settings] { return run_reconstruct(*settings); }};
}

}  // namespace gatelight::apps
