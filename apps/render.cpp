#include <fmt/format.h>

#include <memory>
#include <new>

#include "apps/render/render_run.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

constexpr const char* kRenderFooter =
    R"(SIGINT, SIGTERM and SIGHUP finish the current pass and write the picture so far (exit code 130, 143 or 129); a second
one ends the program at once. SIGUSR1 writes the picture so far to all files of -o and continues.
--config FILE.toml reads flags from a file with lines such as "spp = 256" or "eye = [1, 2, 3]".
Intensities of KHR_lights_punctual are read as radiometric values: W/sr (point, spot) and W/m2 (directional).

Examples:
  gatelight render room.glb -o room.exr -o room.png --spp 256 --size 1920x1080
  gatelight render hall.glb -o hall.png --camera hall --environment 0.65,0.8,1 --exposure 1 --tonemap filmic
  gatelight render house.glb -o house.png --sky "date=2026-06-21, time=18:30, place=48.1,11.6, zone=+2"
  gatelight render robot.glb -o robot-%04d.png --preset standard --frames 0:47
  gatelight render room.glb -o room.png --preset preview --cache-out room.safetensors
  gatelight render room.glb -o room.exr --preset standard --time-limit 10
  gatelight render room.glb -o room.exr --denoiser oidn --max-error 0.05)";

int run_render(RenderSettings settings, const std::vector<std::string>& command, RunTeam& team) {
  set_json_messages(settings.progress == ProgressMode::json);
  apply_display_defaults(settings);
  complete_settings(settings);
  if (!team.writes()) settings.quiet = true;
  check_inputs(settings);
  if (team.writes()) check_outputs(settings);
  set_log_level(settings.quiet, settings.verbose);
  install_signal_handlers();
  // Errors without a file name get the scene's name.
  try {
    return render(settings, command, team);
  } catch (const TrainingDiverged& error) {
    throw TrainingDiverged(fmt::format("{}: {}", settings.scene, error.what()));
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format("{}: {}", settings.scene, error.what()));
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(fmt::format("{}: the machine is out of memory", settings.scene));
  }
}

}  // namespace

Subcommand add_render_command(CLI::App& root, const std::vector<std::string>& command, RunTeam& team) {
  CLI::App* app = add_subcommand(root, "render", "Render a scene to EXR and PNG", kRenderFooter);
  const auto settings = std::make_shared<RenderSettings>();
  const std::vector<Option> options = option_table(*settings);
  add_flags(*app, options);
  return {app,
          [app, settings, command, &team] {
            finish_flags(*app, *settings);
            return run_render(*settings, command, team);
          },
          common_names(options)};
}

}  // namespace gatelight::apps
