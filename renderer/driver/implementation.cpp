#include "renderer/driver/implementation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "base/clock.h"
#include "base/file/digest.h"
#include "base/platform/flush_denormals.h"
#include "base/platform/threads.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cache_report.h"
#include "renderer/cache/cached_pass.h"
#include "renderer/denoise/denoise_time.h"
#include "renderer/distributed/packing.h"
#include "renderer/driver/chosen_integrator.h"
#include "renderer/film/camera_choice.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/fingerprint/deciding_options.h"
#include "renderer/light/soft_sky.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/reference_pass.h"
#include "renderer/transport/shadow_catcher.h"
#include "renderer/transport/view_check.h"

namespace gatelight::renderer {
namespace {

/// Points of a pixel for the shadow catcher under a time limit, whose plan needs their number in advance.
constexpr int kTimedShadowPoints = 64;

RenderOptions checked(const RenderOptions& options) {
  check_light_groups(options);
  if (!options.region) return options;
  const auto& [x0, y0, x1, y1] = *options.region;
  if (x0 < 0 || y0 < 0 || x1 > options.width || y1 > options.height || x0 >= x1 || y0 >= y1) {
    throw BadOption(
        fmt::format("`region` {},{},{},{}: expected x0,y0,x1,y1 within the picture of {}x{}, not empty", x0,
                    y0, x1, y1, options.width, options.height));
  }
  return options;
}

PixelRect region_of(const RenderOptions& options) {
  if (!options.region) return {0, 0, options.width, options.height};
  const auto& [x0, y0, x1, y1] = *options.region;
  return {x0, y0, x1, y1};
}

std::size_t checked_budget(const scene::Scene& scene, const RenderOptions& options) {
  const MemoryEstimate need = estimate_memory(scene, options);
  require_memory(fmt::format("{}: rendering", scene.path), options, need.total(),
                 need.total() - need.geometry);
  if (options.memory_limit_bytes == 0) return 0;
  return options.memory_limit_bytes - (need.total() - need.bvh);
}

/// The memory that a limit leaves to the denoiser; 0: no limit.
std::size_t memory_of_denoiser(const scene::Scene& scene, const RenderOptions& options) {
  if (options.memory_limit_bytes == 0) return 0;
  const std::size_t need = estimate_memory(scene, options).total();
  return std::max(options.memory_limit_bytes - std::min(need, options.memory_limit_bytes), kDenoiserBytes);
}

/// The warning that a denoiser is missing; else empty.
std::string denoiser_warning(const ChosenDenoiser& chosen) {
  if (chosen.missing.empty()) return "";
  return fmt::format("the picture keeps its noise: {}; `denoiser` none silences this", chosen.missing);
}

/// Whether the integrator shows light, and not the openness of surfaces.
bool shows_light(Integrator integrator) {
  return integrator == Integrator::path || integrator == Integrator::nrc;
}

/// The options with an automatic environment resolved for this scene.
RenderOptions with_sky(const scene::Scene& scene, RenderOptions options) {
  options.environment.automatic &= !options.environment.sky && shows_light(options.integrator) &&
                                   (scene.image_light || needs_light(scene));
  return options;
}

/// The warning for a scene without light; else empty. `options` are those of with_sky().
std::string sky_warning(const scene::Scene& scene, const RenderOptions& options) {
  if (options.environment.automatic && !scene.image_light) {
    return fmt::format("{} has no light: a soft sky lights it; `environment` none, r,g,b or FILE replaces it",
                       scene.path);
  }
  if (shows_light(options.integrator) && options.environment.none() && needs_light(scene)) {
    return fmt::format("{} has no light, and the environment is 'none': the picture is black", scene.path);
  }
  return "";
}

/// The warning with the flags of the chosen view, where the file has no camera; else empty.
std::string made_view(const scene::Scene& scene, const CameraOptions& options, const scene::Camera& view) {
  if (!scene.cameras.empty() || options.look_at) return "";
  const Vec3 eye = view.transform.translation() + scene.origin;
  const Vec3 target =
      eye - view.transform.linear().col(2) * (view.transform.translation() - scene.bounds.center()).norm();
  return fmt::format(
      "{} has no camera: the view shows all of it, as `eye` {:.6g},{:.6g},{:.6g} `target` "
      "{:.6g},{:.6g},{:.6g}",
      scene.path, eye.x(), eye.y(), eye.z(), target.x(), target.y(), target.z());
}

}  // namespace

Renderer::Implementation::Implementation(const scene::Scene& scene_in, const RenderOptions& options_in,
                                         Ranks& ranks_in)
    : scene(scene_in),
      chosen_denoiser(choose_denoiser(options_in.denoise, ranks_in)),
      picture_options(with_denoiser(with_sky(scene, checked(options_in)), chosen_denoiser)),
      options(options_of_film(picture_options)),
      ranks(ranks_in),
      threads(options.threads > 0 ? options.threads : available_threads()),
      control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena(threads),
      region(region_of(options)),
      tiles(region),
      threads_of_ranks(one_of_each(ranks, static_cast<double>(threads))),
      shares(tiles.count(), threads_of_ranks),
      own(tiles.part(shares.begin(ranks.rank()), shares.end(ranks.rank()))),
      view(chosen_view(options.camera)),
      filter(options.filter, options.filter_width),
      scale(picture_options.denoise.supersampling, picture_options.filter, picture_options.filter_width),
      budget(checked_budget(scene, picture_options)) {
  const FlushDenormals flush;  // also on the arena's threads, as the arena is made here
  require_threads(threads);
  if (chosen_denoiser.library)
    denoiser = std::make_unique<Denoiser>(*chosen_denoiser.library, threads,
                                          memory_of_denoiser(scene, picture_options));
  const Clock::time_point start = Clock::now();
  arena.execute([&] {
    world.emplace(scene, WorldOptions{options.environment, options.light_selection,
                                      AccelOptions{threads, options.isa, budget, options.watertight},
                                      options.glass_shadows, options.light_groups, options.background});
  });
  look_through(options.camera);
  choose_integrator();
  // A loaded cache needs no more steps, unless the caller sets a number.
  if (!options.cache.train_steps && options.cache.cache_in.empty()) {
    steps_chosen = true;
    options.cache.train_steps = choose_training_steps(
        options, static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height()));
  }
  statistics.build_seconds = seconds_since(start);
  statistics.width = region_of_picture().width();
  statistics.height = region_of_picture().height();
  statistics.threads = threads;
  statistics.isa = world->accel.isa();
  statistics.geometry_bytes = scene::geometry_bytes(scene);
  statistics.bvh_bytes = world->accel.bytes();
  statistics.texture_bytes = world->textures.bytes() + world->environment.bytes();
  statistics.light_bytes = world->lights.bytes() + world->light_arrays.bytes();
}

void Renderer::Implementation::choose_integrator() {
  if (!options.choose_integrator) return;
  const double bounces = arena.execute([&] { return bounces_of_paths(*world, camera, region, options); });
  statistics.bounces_of_paths = bounces;
  picture_options = with_integrator(picture_options, bounces);
  options = options_of_film(picture_options);
}

View Renderer::Implementation::chosen_view(const CameraOptions& chosen) const {
  return choose_camera(scene, chosen, static_cast<float>(options.width) / static_cast<float>(options.height));
}

void Renderer::Implementation::look_through(const CameraOptions& chosen) {
  view = chosen_view(chosen);
  options.camera = chosen;
  std::string focus;
  if (view.lens_radius > 0.0f && !(view.focus_distance > 0.0f)) {
    view.focus_distance = distance_in_the_middle(*world, Camera(view, options.width, options.height),
                                                 options.width, options.height);
    focus =
        fmt::format("the lens is focused at {:.4g} m, on the middle of the picture; `focus` {:.4g} keeps it",
                    view.focus_distance, view.focus_distance);
  }
  camera = Camera(view, options.width, options.height);
  // Rays of an orthographic camera begin at many places.
  if (!view.orthographic) camera.set_around(volumes_around(*world, view.transform.translation()));
  statistics.warnings.clear();
  for (std::string warning :
       {denoiser_warning(chosen_denoiser), sky_warning(scene, options),
        made_view(scene, options.camera, view), std::move(focus), world->environment.warning(),
        view_warning(*world, camera, options.width, options.height)}) {
    if (!warning.empty()) statistics.warnings.push_back(std::move(warning));
  }
}

SceneFingerprint Renderer::Implementation::scene_fingerprint() {
  SceneFingerprint result;
  arena.execute([&] { result = compute_scene_fingerprint(scene, options.environment); });
  return result;
}

CheckpointIdentity Renderer::Implementation::identity(const SceneFingerprint& fingerprint) const {
  NamedTexts machine = {{"isa", world->accel.isa()}};
  if (uses_cache(options.integrator)) machine.push_back({"kernels", cache_machine(options)});
  NamedTexts decisive = deciding_options(options, view, machine);
  // The fingerprint does not include names, which decide here.
  if (const std::vector<std::uint8_t> members = world->light_groups.members(); !members.empty())
    decisive.push_back({"lights-of-groups", hexadecimal(digest_of(std::as_bytes(std::span(members))))});
  return {decisive, fingerprint, scene.instances.size()};
}

std::unique_ptr<Pass> Renderer::Implementation::make_pass(Training& training) {
  const PassContext context{own, options, camera, filter};
  if (training.session) return std::make_unique<CachedPass>(*world, context, *training.session);
  return std::make_unique<ReferencePass>(*world, context);
}

int Renderer::Implementation::samples_of_film(int spp) const {
  RenderOptions of_picture = picture_options;
  of_picture.spp = spp;
  return options_of_film(of_picture).spp;
}

PixelRect Renderer::Implementation::region_of_picture() const {
  return region_of(picture_options);
}

void Renderer::Implementation::add_statistics(const FinishedPicture& finished) {
  statistics.denoise_seconds = finished.denoise_seconds;
  statistics.denoiser =
      finished.denoised ? fmt::format("Open Image Denoise {}", chosen_denoiser.library->version) : "";
  statistics.denoise_failure = finished.failure;
  statistics.estimated_error = finished.estimated_error;
}

CaughtShadows Renderer::Implementation::caught_shadows(double samples_per_pixel) const {
  constexpr int kFewest = 32, kMost = 512;
  if (world->catchers.empty()) return {};
  const int wanted = std::clamp(static_cast<int>(samples_per_pixel), kFewest, kMost);
  const int samples = options.time_limit_seconds > 0.0 ? kTimedShadowPoints : wanted;
  return [this, samples](const PixelRect& rect) {
    return catch_shadows(*world, camera, filter, options, rect, samples);
  };
}

Finishing Renderer::Implementation::finishing(double samples_per_pixel, DenoiseProgress progress) const {
  return {options, denoiser.get(), scale, caught_shadows(samples_per_pixel), std::move(progress)};
}

FinishedPicture Renderer::Implementation::finish(Film& film, const Callbacks& callbacks, bool stopped) {
  const double spp = samples_per_pixel(film);
  FinishedPicture finished;
  gather(film);
  if (!ranks.first()) return finished;
  const auto progress = [&callbacks, stopped, start = Clock::now()](double done) {
    if (callbacks.progress)
      callbacks.progress({.phase = Phase::denoise, .fraction = done, .seconds = seconds_since(start)});
    return stopped || !callbacks.stop || !callbacks.stop();
  };
  finished = finished_picture(film, finishing(spp, progress), arena);
  finished.picture.view = camera.matrices(scene.origin);
  return finished;
}

std::optional<double> Renderer::Implementation::estimate_error(Film& film) {
  gather(film);
  std::optional<double> error;
  if (ranks.first()) error = error_of_picture(film, finishing(1.0, {}), arena);
  return agreed(ranks, error);
}

double Renderer::Implementation::expect_denoise_seconds() {
  if (!denoiser) return 0.0;
  const double alpha = options.background.is_separate() ? 1.5 : 1.0;
  double seconds = 0.0;
  arena.execute([&] {
    failure_to_denoise([&] {  // finish() reports it
      seconds = renderer::expect_denoise_seconds(*denoiser, picture_options.denoise, region.width(),
                                                 region.height());
    });
  });
  return alpha * seconds;
}

double Renderer::Implementation::expect_shadow_seconds() {
  constexpr int kPoints = 4, kWidth = 128;
  if (world->catchers.empty()) return 0.0;
  const int width = std::min(region.width(), kWidth);
  PixelRect strip = region;
  strip.x0 += (region.width() - width) / 2;
  strip.x1 = strip.x0 + width;
  const Clock::time_point start = Clock::now();
  arena.execute([&] { catch_shadows(*world, camera, filter, options, strip, kPoints); });
  return seconds_since(start) * kTimedShadowPoints / kPoints * region.width() / width;
}

Film Renderer::Implementation::make_film() const {
  return {region, options.width, options.height, film_contents(options, world->light_groups.names())};
}

RenderStatistics Renderer::Implementation::sum_up(int spp, double seconds, const Film& film, const Pass* pass,
                                                  const Training& training,
                                                  const RenderStatistics& earlier) const {
  RenderStatistics sum = statistics;
  sum.render_seconds = seconds;
  sum.spp = samples_of_picture(spp);
  SampleCounts counts = pass ? pass->counts() : SampleCounts{};
  counts.add(training.counts);
  sum.rays = pass ? pass->rays() : RayCounts{};
  sum.samples = samples_of_rank(film);
  if (training.session) {
    sum.rays.add(training.session->rays());
    sum.cache = training.session->statistics();
    sum.cache.steps_chosen = training.chosen;
    sum.cache.steps_wanted = training.steps;
    sum.cache.diverged = training.diverged;
    if (pass) pass->add_to(sum.cache);
  }
  sum.nonfinite = counts.nonfinite;
  sum.clamped = counts.clamped;
  sum.nonfinite_samples = std::move(counts.located);
  add_other_ranks(sum, training);
  add_earlier(sum, earlier);
  sum.resumed_seconds = earlier.render_seconds;
  return sum;
}

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options, one_rank())) {}
Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options, Ranks& ranks)
    : implementation_(std::make_unique<Implementation>(scene, options, ranks)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::set_camera(const CameraOptions& camera) {
  implementation_->look_through(camera);
}

Integrator Renderer::integrator() const {
  return implementation_->options.integrator;
}

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

CacheReport Renderer::report_cache() {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheReport report;
  self.arena.execute(
      [&] { report = renderer::report_cache(*self.world, self.camera, self.region, self.options); });
  return report;
}

CacheStatistics Renderer::set_up_cache() {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheStatistics statistics;
  self.arena.execute(
      [&] { statistics = CacheSession(*self.world, self.camera, self.region, self.options).statistics(); });
  return statistics;
}

}  // namespace gatelight::renderer
