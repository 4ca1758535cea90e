#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/errors.h"
#include "apps/log.h"
#include "apps/results.h"
#include "apps/scene_report.h"
#include "apps/stopwatch.h"
#include "apps/subcommand.h"
#include "apps/version.h"
#include "renderer/accel.h"
#include "renderer/atomic_file.h"
#include "renderer/threads.h"
#include "scene/gltf.h"

namespace gatelight::apps {
namespace {

constexpr const char* kFooter = R"(Examples:
  gatelight info
  gatelight info room.glb
  gatelight info room.glb --json - | jq .requirements)";

struct InfoSettings {
  std::string scene;
  std::string json;
  std::string variant;
};

std::string program_text() {
  return fmt::format("{:<14} {}\n{:<14} {}\n{:<14} {}\n{:<14} {}\n", "version", version(), "isa",
                     renderer::best_isa(), "threads", renderer::available_threads(), "embree",
                     embree_version());
}

std::string program_json() {
  const nlohmann::ordered_json json = {{"schema", 1},
                                       {"version", version()},
                                       {"isa", renderer::best_isa()},
                                       {"threads", renderer::available_threads()},
                                       {"embree", embree_version()}};
  return json.dump(1) + "\n";
}

int run_info(const InfoSettings& settings) {
  // A missing texture changes nothing that is told here.
  const scene::LoadOptions options{.variant = settings.variant, .missing_is_error = false};
  if (!settings.json.empty() && settings.json != "-") renderer::check_writable(settings.json);
  std::string text;
  std::string json;
  if (settings.scene.empty()) {
    text = program_text();
    json = program_json();
  } else {
    const Stopwatch watch;
    const scene::Scene scene = scene::load_gltf(settings.scene, options);
    const SceneReport report = make_scene_report(scene, watch.seconds());
    for (const std::string& warning : scene.warnings) log_warning(warning);
    text = scene_report_text(scene, report);
    json = scene_report_json(scene, report);
  }
  if (!settings.json.empty()) write_text(settings.json, json);
  // JSON on stdout stands alone, so that it can be parsed.
  if (settings.json != "-") write_text("-", text);
  return kDone;
}

}  // namespace

Subcommand add_info_command(CLI::App& root) {
  CLI::App* app = root.add_subcommand("info", "Tell what a scene holds and needs, or what this program is");
  app->footer(kFooter);
  const auto settings = std::make_shared<InfoSettings>();
  app->add_option("SCENE", settings->scene, "Scene, .gltf or .glb; without it: version, ISA, threads, Embree")
      ->type_name("");
  app->add_option("--json", settings->json, "The same as JSON; - is stdout")->type_name("FILE|-");
  app->add_option("--variant", settings->variant, "Material variant of the file, by name")->type_name("NAME");
  return {app, [settings] { return run_info(*settings); }};
}

}  // namespace gatelight::apps
