#include "apps/render/stills.h"

#include <fmt/format.h>

#include "apps/settings/camera_names.h"
#include "apps/settings/picture_output.h"
#include "apps/terminal/errors.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {

int note_signal_before_picture(Console& console, int signal, const std::string& scene) {
  return console.note_signal(signal,
                             fmt::format("before the first pass of '{}'; nothing was written", scene));
}

int render_stills(const RenderSettings& settings, const scene::Scene& scene, PictureMaker& maker,
                  Clock::time_point start) {
  Console& console = maker.console;
  const RunTeam& team = maker.team;
  std::vector<RenderSettings> pictures = pictures_of(settings, scene);
  if (settings.skip_existing) {
    const std::size_t count = pictures.size();
    std::erase_if(pictures,
                  [&team](const RenderSettings& picture) { return team.agreed(are_there(picture.outputs)); });
    console.note_skipped(count - pictures.size(), count);
    if (pictures.empty()) return kDone;
  }
  console.progress.phase("build");
  const std::size_t warnings_of_loading = console.report.warnings.size();
  renderer::Renderer renderer(scene, pictures.front().render);
  int code = kDone;
  for (std::size_t i = 0; i < pictures.size() && code == kDone; ++i) {
    RenderSettings& picture = pictures[i];
    if (i > 0) {
      start = Clock::now();
      console.report.warnings.resize(warnings_of_loading);
      renderer.set_camera(picture.render.camera);
    }
    renderer::use_chosen(picture.render, renderer.chosen());
    maker.begin(picture, start);
    console.warn(renderer.statistics().warnings);
    if (const int number = team.signal(); number != 0)
      return note_signal_before_picture(console, number, picture.scene);
    renderer::Picture made = renderer.render(maker.callbacks(renderer));
    code = maker.finish(std::move(made), renderer.statistics());
  }
  return code;
}

}  // namespace gatelight::apps
