#include <optional>
#include <utility>

#include "base/platform/flush_denormals.h"
#include "renderer/cache/cache_report.h"
#include "renderer/cache/cache_session.h"
#include "renderer/driver/frame_memory.h"
#include "renderer/driver/picture_run.h"
#include "renderer/driver/render_series.h"
#include "renderer/render.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/temporal/frame_file.h"

namespace gatelight::renderer {

struct Renderer::Implementation {
  Implementation(const scene::Scene& scene, const RenderOptions& options)
      : picture(scene, options), team(std::in_place, picture), statistics(picture.statistics) {}

  void set_options(const RenderOptions& options) {
    const PixelRect region = picture.region;
    picture.set_options(options);
    statistics = picture.statistics;
    memory.fresh_steps = steps_of_frames(picture);
    if (picture.region == region) return;
    team.emplace(picture);
    memory.forget();
  }

  PreparedPicture picture;
  std::optional<PictureTeam> team;
  RenderStatistics statistics;
  FrameMemory memory;
};

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::set_camera(const CameraOptions& camera) {
  Implementation& self = *implementation_;
  self.picture.change_view(camera);
  self.statistics.warnings = self.picture.statistics.warnings;
  self.statistics.light_behind_walls = self.picture.statistics.light_behind_walls;
}

std::optional<bool> Renderer::soft_sky() const {
  return implementation_->picture.sky_of_view();
}

void Renderer::keep_soft_sky(std::optional<bool> sky) {
  implementation_->picture.kept_sky = sky;
}

void Renderer::set_options(const RenderOptions& options) {
  implementation_->set_options(options);
}

void Renderer::scene_moved(const CameraOptions& camera) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  self.picture.scene_moved(camera);
  self.statistics = self.picture.statistics;
}

void Renderer::scout() {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  const PreparedPicture& p = self.picture;
  if (!uses_cache(p.options.integrator)) return;
  p.arena.execute(
      [&] { self.memory.scouting.add(*p.world, p.camera, p.region, p.options, self.team->records()); });
  self.memory.scouted = true;
}

void Renderer::begin_frames(double seconds, const std::filesystem::path& file) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  self.memory.begin(self.picture, self.team->records(), seconds, file);
}

void Renderer::restore_frame(const std::filesystem::path& file) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  self.memory.restore(self.picture, file);
}

Picture Renderer::render_frame(int frame, const Callbacks& callbacks) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  self.picture.begin_frame(frame);
  self.memory.frame = frame;
  Picture picture = render_picture({self.picture, *self.team, callbacks}, self.statistics, &self.memory);
  self.memory.last_frame = frame;
  return picture;
}

void Renderer::note_frame(int frame, const CameraOptions& camera) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  self.memory.note_view(self.picture, self.picture.chosen_view(camera), frame);
}

bool Renderer::knows_frame(int frame) const {
  return !implementation_->team->finishes() || implementation_->memory.knows_view(frame);
}

void Renderer::write_frame(const std::filesystem::path& path, std::optional<float> exposure) const {
  implementation_->memory.write(implementation_->picture, path, exposure);
}

FrameStatus read_frame_status(const std::filesystem::path& path) {
  return FrameFile(path).status();
}

Picture Renderer::render(const Callbacks& callbacks) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  Picture picture = render_picture({self.picture, *self.team, callbacks}, self.statistics);
  for (RenderOptions* of : {&self.picture.options, &self.picture.options_of_picture})
    use_device(*of, self.statistics.cache);  // later pictures choose the same
  return picture;
}

bool Renderer::render_series(const Series& series, const SeriesPicture& picture, const Callbacks& callbacks) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  return renderer::render_series({self.picture, *self.team, callbacks}, series, picture, self.statistics);
}

CacheReport Renderer::report_cache() {
  const FlushDenormals flush;
  const PreparedPicture& p = implementation_->picture;
  return p.arena.execute([&] { return renderer::report_cache(*p.world, p.camera, p.region, p.options); });
}

CacheStatistics Renderer::set_up_cache() {
  const FlushDenormals flush;
  const PreparedPicture& p = implementation_->picture;
  return p.arena.execute([&] { return CacheSession(*p.world, p.camera, p.region, p.options).statistics(); });
}

ChosenOptions Renderer::chosen() const {
  const RenderOptions& options = implementation_->picture.options;
  return {options.integrator, options.watertight};
}

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

}  // namespace gatelight::renderer
