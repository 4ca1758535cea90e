#include "renderer/merge.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/errors.h"
#include "apps/results.h"
#include "apps/seeds.h"
#include "apps/subcommand.h"
#include "renderer/image_format.h"
#include "renderer/image_read.h"
#include "renderer/image_write.h"

namespace gatelight::apps {
namespace {

constexpr const char* kMergeFooter =
    R"(A reference in parts: each rendered with a seed of its own, on any day and machine. The mean is weighted by the samples
per pixel that each file tells (gatelight:spp in its header), and tells their sum. Size and layers must be the same. Of
layers that have no mean, samples are added up, variance becomes that of the mean, and ids are those of the first file.

Example:
  for seed in 1 2 3 4; do gatelight render room.glb -o part-$seed.exr --exr float --spp 256 --seed $seed; done
  gatelight merge -o reference.exr part-*.exr)";

struct MergeSettings {
  std::string output;
  std::vector<std::string> inputs;
};

void require_exr(const std::string& file) {
  if (renderer::image_format(file) == renderer::ImageFormat::exr) return;
  throw UsageError(fmt::format("merge: '{}' is not an .exr file", file));
}

int run_merge(const MergeSettings& settings) {
  require_exr(settings.output);
  for (const std::string& input : settings.inputs) require_exr(input);
  renderer::check_image_output(settings.output);
  renderer::PictureMerger merger;
  SeedsSeen seeds;
  for (const std::string& input : settings.inputs) {
    const renderer::Picture picture = renderer::read_image(input);
    seeds.add(picture, input);
    merger.add({picture, input});
  }
  renderer::write_image(merger.finish(), settings.output);
  return kDone;
}

}  // namespace

Subcommand add_merge_command(CLI::App& root) {
  CLI::App* app = root.add_subcommand("merge", "Average pictures of one scene with different seeds");
  app->footer(kMergeFooter);
  const auto settings = std::make_shared<MergeSettings>();
  app->add_option("-o,--output", settings->output, "Picture to write, 32-bit .exr")
      ->type_name("FILE")
      ->required();
  app->add_option("INPUT", settings->inputs, "Pictures, .exr")->type_name("")->required();
  return {app, [settings] { return run_merge(*settings); }};
}

}  // namespace gatelight::apps
