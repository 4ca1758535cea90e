#include <memory>

#include "apps/render_run.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/subcommand.h"

namespace gatelight::apps {
namespace {

constexpr const char* kRenderFooter =
    R"(SIGINT, SIGTERM and SIGHUP finish the current pass and write the picture so far (exit code 130, 143 or 129); a second
one ends the program at once. SIGUSR1 writes a snapshot of all outputs.
Any flag can stand in a file given with --config FILE.toml, as "spp = 256" or "eye = [1, 2, 3]".

Examples:
  gatelight render room.glb -o room.exr -o room.png --spp 256 --size 1920x1080
  gatelight render hall.glb -o hall.png --camera hall --environment 0.65,0.8,1 --exposure 1 --tonemap filmic
  gatelight render car.gltf -o car.exr --eye 4,1.5,4 --target 0,0.5,0 --fov 30 --aov albedo,normal,depth
  gatelight render room.glb -o room.exr -o room.png --integrator nrc --train-steps 1024
  gatelight render room.glb -o room.png --preset preview --cache-out room.safetensors
  gatelight render room.glb -o room.exr --time-limit 60 --stats room.json --progress json)";

}  // namespace

Subcommand add_render_command(CLI::App& root, const std::vector<std::string>& command) {
  CLI::App* app = add_subcommand(root, "render", "Render a scene to EXR and PNG", kRenderFooter);
  const auto settings = std::make_shared<RenderSettings>();
  add_flags(*app, option_table(*settings));
  return {app, [app, settings, command] {
            finish_flags(*app, *settings);
            return run_render(*settings, command);
          }};
}

}  // namespace gatelight::apps
