#include "apps/render/render_run.h"

#include <fmt/format.h>

#include "apps/render/frames.h"
#include "apps/render/stills.h"
#include "apps/reports/picture_warnings.h"
#include "apps/reports/recipe.h"
#include "apps/settings/unused_flags.h"
#include "apps/terminal/log.h"
#include "apps/terminal/text.h"
#include "renderer/denoise/oidn_library.h"
#include "scene/gltf.h"

namespace gatelight::apps {
namespace {

/// With the time of a still in the middle of its shutter.
scene::LoadOptions load_options(const RenderSettings& settings) {
  scene::LoadOptions options = settings.load;
  const FrameSettings& frames = settings.frames;
  if (!frames.range && options.time) *options.time += frames.shutter.middle() / frames.fps;
  return options;
}

void note_loaded(Console& console, const RenderSettings& settings, const scene::Scene& scene) {
  console.warn(scene.warnings);
  if (settings.load.time && scene.animations.empty() && settings.frames.turntable == 0)
    console.warn("the file has no animations: --time has no effect");
  if (!settings.verbose) return;
  console.progress.clear();
  log_detail(fmt::format("{}: {} triangles, {} instances, {} punctual lights", settings.scene,
                         format_integer(scene::count_triangles(scene)), scene.instances.size(),
                         scene.lights.size()));
  log_detail(fmt::format("options: {}", dump_options(settings)));
}

}  // namespace

int render(RenderSettings settings, const std::vector<std::string>& command, RunTeam& team) {
  const Clock::time_point start = Clock::now();
  team.join(settings);
  Console console(settings);
  console.report.command = command;
  // A scene may take long to load.
  if (team.writes() && settings.render.denoise.denoiser == renderer::DenoiserKind::oidn)
    renderer::load_oidn(settings.render.denoise.library);
  console.warn(unused_output_flags(settings));
  console.progress.phase("load");
  const Clock::time_point load_start = Clock::now();
  scene::SceneFile file(settings.scene, load_options(settings));
  scene::Scene scene = file.load();
  console.report.load_seconds = seconds_since(load_start);
  note_loaded(console, settings, scene);
  if (const int number = team.signal(); number != 0)
    return note_signal_before_picture(console, number, settings.scene);
  team.check(settings, scene);
  PictureMaker maker(console, team, lights_from_watts(scene));
  return settings.frames.range ? render_frames(settings, file, scene, maker)
                               : render_stills(settings, scene, maker, start);
}

}  // namespace gatelight::apps
