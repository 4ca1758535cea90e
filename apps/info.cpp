#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/reports/cache_statistics.h"
#include "apps/reports/picture_report.h"
#include "apps/reports/scene_report.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/file_names.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/clock.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/platform/threads.h"
#include "neural/vulkan/devices.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_read.h"
#include "renderer/render.h"
#include "renderer/surface/embree.h"
#include "scene/gltf.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

constexpr const char* kInfoFooter =
    R"(With --integrator nao or nrc, it also describes the cache that the scene would get for the view of these flags: memory,
feature vectors, resolutions and sides of the instances, and inputs of the network. Nothing is trained.

For an EXR file of gatelight, it prints size, layers and the recipe in the header, which says how the picture was made.

Examples:
  gatelight info
  gatelight info room.glb
  gatelight info room.glb --integrator nrc --node-spacing 0.05
  gatelight info room.glb --json - | jq .requirements
  gatelight info room.exr
  gatelight info room.exr --command)";

struct InfoSettings {
  RenderSettings render;  ///< its scene may be a picture
  std::string json;
  bool command = false;
};

struct DeviceReport {
  std::vector<neural::vulkan::DeviceListing> devices;
  std::string reason;  ///< why there is no device
};

DeviceReport find_devices() {
  try {
    DeviceReport report{neural::vulkan::list_devices(), ""};
    if (report.devices.empty()) report.reason = "no device";
    return report;
  } catch (const Unavailable& error) {
    return {{}, error.what()};
  }
}

/// A line for each device.
std::string devices_text(const DeviceReport& report) {
  if (report.devices.empty()) return fmt::format("{:<14} {}\n", "vulkan", report.reason);
  std::string text;
  for (std::size_t i = 0; i < report.devices.size(); ++i) {
    const neural::vulkan::DeviceListing& device = report.devices[i];
    text += fmt::format("{:<14} {}: {} ({}, Vulkan {}, {}){}{}\n", i == 0 ? "vulkan" : "", i, device.name,
                        device.kind, device.version, format_bytes(device.memory_bytes),
                        device.refusal.empty() ? "" : ", cannot be used: ", device.refusal);
  }
  return text;
}

ordered_json devices_json(const DeviceReport& report) {
  ordered_json devices = ordered_json::array();
  for (const neural::vulkan::DeviceListing& device : report.devices)
    devices.push_back({{"name", device.name},
                       {"kind", device.kind},
                       {"version", device.version},
                       {"memory_bytes", device.memory_bytes},
                       {"usable", device.refusal.empty()},
                       {"refusal", device.refusal}});
  return {{"built_in", neural::vulkan::is_built_in()}, {"reason", report.reason}, {"devices", devices}};
}

std::string program_text() {
  return fmt::format("{:<14} {}\n{:<14} {}\n{:<14} {}\n{:<14} {}\n{:<14} {}\n{}", "version", version(), "isa",
                     renderer::best_isa(), "threads", available_threads(), "embree",
                     renderer::embree_version(), "denoiser", denoiser_text(), devices_text(find_devices()));
}

ordered_json program_json() {
  return {{"schema", 1},
          {"version", version()},
          {"isa", renderer::best_isa()},
          {"threads", available_threads()},
          {"embree", renderer::embree_version()},
          {"denoiser", denoiser_text()},
          {"vulkan", devices_json(find_devices())}};
}

struct Description {
  std::string text;
  ordered_json json;
};

Description describe_scene(const RenderSettings& settings) {
  const Clock::time_point start = Clock::now();
  const scene::Scene scene = scene::load_gltf(settings.scene, settings.load);
  const double seconds = seconds_since(start);
  const scene::SceneRequirements requirements = scene::compute_requirements(scene);
  for (const std::string& warning : scene.warnings) log_warning(warning);
  Description description{scene_report_text(scene, requirements, seconds),
                          scene_report_json(scene, requirements, seconds)};
  if (renderer::uses_cache(settings.render.integrator)) {
    const renderer::CacheReport cache = renderer::Renderer(scene, settings.render).report_cache();
    description.text += cache_report_text(cache, settings.render);
    description.json["cache"] = cache_report_json(cache, settings.render);
  }
  return description;
}

Description describe_picture(const std::string& file, bool command) {
  renderer::Picture picture;
  // Other formats carry no recipe.
  if (renderer::image_format(file) == renderer::ImageFormat::exr) picture = renderer::read_image(file);
  require_recipe(file, picture);
  if (!command) return {picture_report_text(file, picture), picture_report_json(file, picture)};
  const std::string line = picture_command(file, picture);
  return {line, picture_report_json(file, picture)};
}

Description describe(const InfoSettings& settings) {
  const std::string& file = settings.render.scene;
  if (file.empty()) return {program_text(), program_json()};
  return is_picture(file) ? describe_picture(file, settings.command) : describe_scene(settings.render);
}

void check_picture_flags(const InfoSettings& settings) {
  const std::string& file = settings.render.scene;
  if (settings.command && !is_picture(file))
    throw BadOption({"command", "", "prints the command line of a picture", "PICTURE.exr"});
  if (is_picture(file) && !settings.render.given.empty()) {
    throw BadOption({*settings.render.given.begin(), "",
                     fmt::format("applies to scenes, but '{}' is a picture", file),
                     "only `command` or `json`"});
  }
}

int run_info(InfoSettings settings) {
  check_picture_flags(settings);
  if (settings.render.scene.empty() && !settings.render.given.empty()) {
    throw BadOption({*settings.render.given.begin(), "", "has no effect without a scene", "SCENE"});
  }
  complete_settings(settings.render);
  read_files(settings.render).write("json", settings.json);
  if (!settings.json.empty() && settings.json != "-") check_writable(settings.json);
  const Description description = describe(settings);
  if (!settings.json.empty()) {
    write_text(settings.json, json_text(description.json) + "\n");
  }
  // With JSON on stdout nothing else is printed there, so that it can be parsed.
  if (settings.json != "-") write_text("-", description.text);
  return kDone;
}

}  // namespace

Subcommand add_info_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "info", "Describe a scene, a rendered picture, or this program", kInfoFooter);
  const auto settings = std::make_shared<InfoSettings>();
  // A missing texture changes little of this report.
  settings->render.load.missing_is_error = false;
  Option scene = positional("SCENE", settings->render.scene,
                            "Scene, .gltf or .glb, or a rendered .exr. Without it, print version, ISA, "
                            "threads, Embree, denoiser and Vulkan devices");
  scene.required = false;
  std::vector<Option> options = {scene};
  OptionGroup output{options, "Output"};
  output.add(any_word("json", settings->json, "FILE|-", "Write the description as JSON; - is stdout"),
             {.common = true});
  output.add(
      toggle("command", settings->command, "Print only the command line that made PICTURE.exr, for a shell"),
      {.common = true});
  const std::vector<Option> of_cache = cache_report_table(settings->render);
  options.insert(options.end(), of_cache.begin(), of_cache.end());
  add_flags(*app, options);
  return {app,
          [app, settings] {
            finish_flags(*app, settings->render);
            // These flags belong to the call, not to the scene.
            for (const char* name : {"SCENE", "json", "command"}) settings->render.given.erase(name);
            return run_info(*settings);
          },
          common_names(options)};
}

}  // namespace gatelight::apps
