#include "renderer/driver/frame_memory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "renderer/cache/cache_file.h"
#include "renderer/cache/light_change.h"
#include "renderer/driver/cache_sessions.h"
#include "renderer/settings/enum_names.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/temporal/frame_file.h"

namespace gatelight::renderer {
namespace {

/// From this change of the light on the cache begins anew.
constexpr double kChanged = 0.1;
/// Steps of a cache for many frames, in those of a still with as many samples: presets of frames have three
/// quarters of the samples of a still, and as many steps.
constexpr double kStepsOfFrames = 4.0 / 3.0;

/// The way in the picture from an earlier view, or to a later one. `other`: null for none, which is no
/// motion.
Layer motion_layer(const PreparedPicture& picture, Aov aov, const PreviousView* other) {
  const RenderOptions& options = picture.options_of_picture;
  const PixelRect rect = picture.region_of_picture();
  Layer layer{.name = enum_name(aov), .channels = {"X", "Y"}, .full_precision = true};
  layer.values.assign(2 * rect.index(rect.x0, rect.y1), 0.0f);
  if (!other) return layer;
  const float forward = aov == Aov::motion_next ? -1.0f : 1.0f;
  const Camera camera(picture.view, options.width, options.height);
  const VisiblePoints points = trace_visible_points(*picture.world, camera, rect, other);
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::size_t i = rect.index(x, y);
      if (!points.earlier[i]) continue;
      const Vec2& there = points.earlier[i]->pixel;
      layer.values[2 * i] = forward * (static_cast<float>(x) + 0.5f - there.x());
      layer.values[2 * i + 1] = forward * (there.y() - (static_cast<float>(y) + 0.5f));
    }
  }
  return layer;
}

}  // namespace

int steps_of_frames(const PreparedPicture& picture) {
  const RenderOptions& options = picture.options;
  if (options.cache.train_steps && !picture.steps_chosen) return *options.cache.train_steps;
  const auto pixels = static_cast<std::uint64_t>(picture.region.width()) *
                      static_cast<std::uint64_t>(picture.region.height());
  return static_cast<int>(std::lround(kStepsOfFrames * choose_training_steps(options, pixels)));
}

void FrameMemory::begin(const PreparedPicture& picture, const RecordExchange& exchange, double seconds,
                        const std::filesystem::path& file_name) {
  const RenderOptions& options = picture.options;
  fingerprint = picture.fingerprint();
  layout_seconds = seconds;
  if (!uses_cache(options.integrator)) return;
  fresh_steps = steps_of_frames(picture);
  if (!file_name.empty()) {
    cache = read_session(picture, exchange, file_name, fingerprint, frame_tensors());
  } else if (scouted) {
    const ScoutReport report = picture.arena.execute([&] { return scouting.report(picture.scene, options); });
    cache = make_session(picture, exchange, &report.setup);
  } else {
    cache = make_session(picture, exchange, nullptr);
  }
}

void FrameMemory::restore(const PreparedPicture& picture, const std::filesystem::path& path) {
  FrameFile file(path);
  FrameLight light = file.read_light(fingerprint, picture.region.width(), picture.region.height());
  last_frame = file.status().frame;
  if (light.empty()) return;
  VisiblePoints points = picture.arena.execute(
      [&] { return trace_visible_points(*picture.world, picture.camera, picture.region, nullptr); });
  history = std::make_unique<History>(History{.view = {SceneSnapshot(picture.scene), picture.camera},
                                              .rect = picture.region,
                                              .points = std::move(points.now),
                                              .color = std::move(light.color),
                                              .samples = std::move(light.samples)});
  if (!picture.scene.motion.any()) return;
  history->probes = picture.arena.execute([&] { return probe_light(*picture.world, history->points); });
}

Reuse FrameMemory::reuse(const PreparedPicture& picture, const Film& film) {
  const PixelRect& rect = film.rect();
  VisiblePoints points =
      trace_visible_points(*picture.world, picture.camera, rect, history ? &history->view : nullptr);
  std::vector<Color> probes;
  if (picture.scene.motion.any()) probes = probe_light(*picture.world, points.now);
  return reuse_samples(film, std::move(points), std::move(probes), history.get());
}

void FrameMemory::note_view(const PreparedPicture& picture, const View& view, int of_frame) {
  const RenderOptions& options = picture.options_of_picture;
  views_.insert_or_assign(
      of_frame, PreviousView{SceneSnapshot(picture.scene), Camera(view, options.width, options.height)});
}

std::vector<Layer> FrameMemory::motion(const PreparedPicture& picture) {
  std::vector<Layer> layers;
  for (const auto& [aov, other] : {std::pair(Aov::motion, frame - 1), {Aov::motion_next, frame + 1}}) {
    if (!has(picture.options.aovs, aov)) continue;
    const auto view = views_.find(other);
    layers.push_back(motion_layer(picture, aov, view == views_.end() ? nullptr : &view->second));
  }
  if (layers.empty()) return layers;
  note_view(picture, picture.view, frame);
  std::erase_if(views_, [this](const auto& of) { return std::abs(of.first - frame) > 1; });
  return layers;
}

void FrameMemory::keep(const PreparedPicture& picture, const std::vector<float>& denoised,
                       const Reuse& reuse) {
  history = std::make_unique<History>(History{.view = {SceneSnapshot(picture.scene), picture.camera},
                                              .rect = picture.region,
                                              .points = reuse.points.now,
                                              .color = denoised,
                                              .samples = reuse.samples,
                                              .probes = reuse.probes});
}

void FrameMemory::write(const PreparedPicture& picture, const std::filesystem::path& path,
                        std::optional<float> exposure) const {
  const FrameStatus status{.frame = last_frame, .layout_seconds = layout_seconds, .exposure = exposure};
  FrameLight light;
  if (history) {
    light = {history->rect.width(), history->rect.height(), history->color, history->samples};
  }
  if (!cache) return write_frame_file(path, status, light, fingerprint);
  write_cache_file(path, cache->export_state(), cache->model(), cache->learning(), picture.cache_meaning(),
                   fingerprint, frame_content(status, light));
}

int steps_after_change(double change, int steps) {
  const double share = std::clamp((change - kUnchangedLight) / (kChanged - kUnchangedLight), 0.0, 1.0);
  return static_cast<int>(std::lround(share * steps));
}

bool begins_anew(double change) {
  return change >= kChanged;
}

}  // namespace gatelight::renderer
