#include "renderer/metrics/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/seeds.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"

namespace gatelight::apps {
namespace {

constexpr const char* kMergeFooter =
    R"(Use it for a reference that is rendered in parts, each with a different seed, at any time and on any machine. The mean
is weighted by the samples per pixel of each file (gatelight:spp in its header); the new header contains their sum.
Size, layers and integrator must be the same, and all values finite. Sample counts are added, variance becomes that of
the mean, and ids and Cryptomattes are those of the first file.

Example:
  for seed in 1 2 3 4; do gatelight render room.glb -o part-$seed.exr --exr float --spp 256 --seed $seed; done
  gatelight merge -o reference.exr part-*.exr)";

/// Warns once of a picture of another scene. It only warns, because the same file may have another name
/// elsewhere.
class ScenesSeen {
 public:
  void add(const renderer::Picture& picture, const std::string& file) {
    const auto scene = picture.metadata.find("scene");
    if (scene == picture.metadata.end()) return;
    const std::string name = std::filesystem::path(scene->second).filename();
    if (first_.empty()) {
      first_ = name;
    } else if (name != first_ && !warned_) {
      log_warning(
          fmt::format("'{}' shows the scene '{}', but the previous files show '{}'", file, name, first_));
      warned_ = true;
    }
  }

 private:
  std::string first_;
  bool warned_ = false;
};

struct MergeSettings {
  std::string output;
  std::vector<std::string> inputs;
};

void require_exr(const std::string& file) {
  if (renderer::image_format(file) == renderer::ImageFormat::exr) return;
  throw BadOption({"INPUT", file, "", "an .exr file"});
}

void require_finite(const renderer::Picture& picture, const std::string& file) {
  for (const renderer::Layer& layer : picture.layers) {
    const auto finite = [](float value) { return std::isfinite(value); };
    const auto good = std::count_if(layer.values.begin(), layer.values.end(), finite);
    const auto bad = static_cast<std::ptrdiff_t>(layer.values.size()) - good;
    if (bad == 0) continue;
    throw InputError(fmt::format("'{}' has {} values that are not finite{}, expected none", file, bad,
                                 layer.name.empty() ? "" : fmt::format(" in its layer '{}'", layer.name)));
  }
}

int run_merge(const MergeSettings& settings) {
  refuse_frame_place("output", settings.output);
  require_exr(settings.output);
  for (const std::string& input : settings.inputs) require_exr(input);
  renderer::check_image_output(settings.output);
  renderer::PictureMerger merger;
  SeedsSeen seeds;
  ScenesSeen scenes;
  for (const std::string& input : settings.inputs) {
    const renderer::Picture picture = renderer::read_image(input);
    require_finite(picture, input);
    seeds.add(picture, input);
    scenes.add(picture, input);
    merger.add({picture, input});
  }
  renderer::write_image(merger.finish(), settings.output);
  return kDone;
}

}  // namespace

Subcommand add_merge_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "merge", "Average pictures of one scene with different seeds", kMergeFooter);
  const auto settings = std::make_shared<MergeSettings>();
  Option output = any_word("output", settings->output, "FILE", "Picture to write, 32-bit .exr");
  output.letter = "-o";
  output.required = true;
  Option inputs = any_words("INPUT", settings->inputs, "", "Pictures, .exr");
  inputs.positional = inputs.required = true;
  add_flags(*app, {output, inputs});
  return {.app = app, .run = [settings] { return run_merge(*settings); }};
}

}  // namespace gatelight::apps
