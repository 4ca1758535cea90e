#include "renderer/driver/prepared_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/clock.h"
#include "base/errors.h"
#include "base/platform/flush_denormals.h"
#include "base/platform/threads.h"
#include "renderer/cache/cache_model.h"
#include "renderer/driver/background.h"
#include "renderer/driver/scene_choices.h"
#include "renderer/film/camera_choice.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/light/soft_sky.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/dark_share.h"
#include "renderer/transport/noisy_guides.h"
#include "renderer/transport/view_check.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kByLobe =
    "has objects or lights that only some bounces find, and a cache does not tell bounces apart";

RenderOptions checked(const RenderOptions& options) {
  check_light_groups(options);
  if (!options.region) return options;
  const auto& [x0, y0, x1, y1] = *options.region;
  if (x0 < 0 || y0 < 0 || x1 > options.width || y1 > options.height || x0 >= x1 || y0 >= y1) {
    throw BadOption(
        {"region", fmt::format("{},{},{},{}", x0, y0, x1, y1), "",
         fmt::format("x0,y0,x1,y1 within the picture of {}x{}, not empty", options.width, options.height)});
  }
  return options;
}

PixelRect region_of(const RenderOptions& options) {
  if (!options.region) return {0, 0, options.width, options.height};
  const auto& [x0, y0, x1, y1] = *options.region;
  return {x0, y0, x1, y1};
}

float aspect_of(const RenderOptions& options) {
  return static_cast<float>(options.width) / static_cast<float>(options.height);
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

/// Whether the scene has no lights but what glows, and the options leave the rest to the renderer.
bool may_need_sky(const scene::Scene& scene, const RenderOptions& options) {
  return options.environment.automatic && !options.environment.sky && shows_light(options.integrator) &&
         scene.lights.empty() && !scene.image_light && reflects(scene);
}

/// The warning for a scene without light; else empty. `options` have the environment that was chosen.
std::string sky_warning(const scene::Scene& scene, const RenderOptions& options, bool asks_for_sky) {
  if (asks_for_sky && options.environment.automatic) {
    return fmt::format(
        "{} has no light that illuminates its surfaces: a soft sky is added; `environment` none, r,g,b or "
        "FILE replaces it",
        scene.path);
  }
  if (!asks_for_sky && shows_light(options.integrator) && options.environment.none() &&
      scene.lights.empty() && reflects(scene) && !glows(scene))
    return fmt::format("{} has no light, and the environment is 'none': the picture is black", scene.path);
  return "";
}

/// The warning with the flags of the chosen view, where the file has no camera; else empty.
std::string made_view(const scene::Scene& scene, const CameraOptions& options, const scene::Camera& view) {
  if (!scene.cameras.empty() || options.look_at || scene.instances.empty()) return "";
  const Vec3 eye = view.transform.translation() + scene.origin;
  const Vec3 target =
      eye - view.transform.linear().col(2) * (view.transform.translation() - scene.bounds.center()).norm();
  return fmt::format(
      "{} has no camera: the view shows all of it, as `eye` {:.6g},{:.6g},{:.6g} `target` "
      "{:.6g},{:.6g},{:.6g}",
      scene.path, eye.x(), eye.y(), eye.z(), target.x(), target.y(), target.z());
}

}  // namespace

PreparedPicture::PreparedPicture(const scene::Scene& scene_in, const RenderOptions& options_in)
    : scene(scene_in),
      threads(options_in.threads > 0 ? options_in.threads : available_threads()),
      control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena(threads) {
  set_options(options_in);
}

void PreparedPicture::set_options(const RenderOptions& chosen) {
  const FlushDenormals flush;  // also on the arena's threads, which begin here
  if (chosen.threads > 0 && chosen.threads != threads)
    throw BadOption(
        {"threads", fmt::format("{}", chosen.threads), "", fmt::format("{}, as before", threads)});
  choose_options(chosen);
  require_threads(threads);
  if (chosen_denoiser.library && !denoiser)
    denoiser = std::make_unique<Denoiser>(*chosen_denoiser.library, threads,
                                          memory_of_denoiser(scene, options_of_picture));
  const Clock::time_point start = Clock::now();
  build_world(judges_view() ? options_to_judge(false) : world_options());
  set_camera(options.camera);
  choose_by_paths();
  // A loaded cache needs no more steps, unless the caller sets a number.
  steps_chosen = !options.cache.train_steps && options.cache.cache_in.empty();
  if (steps_chosen) {
    options.cache.train_steps = choose_training_steps(
        options, static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height()));
  }
  statistics.build_seconds = seconds_since(start);
  describe();
}

void PreparedPicture::choose_options(const RenderOptions& chosen) {
  const OidnLibrary* const library = chosen_denoiser.library;
  chosen_denoiser = choose_denoiser(chosen);
  if (chosen_denoiser.library != library) denoiser.reset();
  RenderOptions next = with_denoiser(checked(chosen), chosen_denoiser);
  asks_for_sky = may_need_sky(scene, next);
  next.environment.automatic = next.environment.automatic && !next.environment.sky &&
                               shows_light(next.integrator) && (asks_for_sky || scene.image_light);
  leave_cache(next);
  const RenderOptions& before = options_of_picture;
  if (next.background != before.background || next.width != before.width || next.height != before.height)
    check_background(next.background, next.width, next.height);
  options_of_picture = std::move(next);
  options = options_of_film(options_of_picture);
  region = region_of(options);
  filter = FilterSampler(options.filter, options.filter_width);
  scale = ScaleDown(options_of_picture.denoise.supersampling, options_of_picture.filter,
                    options_of_picture.filter_width);
  seed_ = options.seed;
  chooses_watertight_ = options.watertight == Watertight::automatic;
  bvh_budget = checked_budget(scene, options_of_picture);
}

void PreparedPicture::leave_cache(RenderOptions& next) {
  left_cache_.clear();
  if (next.integrator != Integrator::nrc || !sees_by_lobe(scene)) return;
  for (const std::string* file : {&next.cache.cache_in, &next.cache.cache_out}) {
    if (!file->empty())
      throw BadOption({"integrator", "nrc", fmt::format("{} {}", scene.path, kByLobe), "`integrator` path"});
  }
  use_integrator(next, Integrator::path);
  left_cache_ = fmt::format("{} {}: `integrator` path is used", scene.path, kByLobe);
}

void PreparedPicture::build_world(const WorldOptions& wanted) {
  if (world && built_ == wanted) return;
  ReusableParts lasting;
  if (world) {
    lasting.textures = world->lasting.textures;
    if (built_.environment == wanted.environment) lasting.environment = world->lasting.environment;
    // Which meshes ask for their coverage, and which rays meet them, is built into the BVH.
    if (built_.acceleration == wanted.acceleration && built_.glass_shadows == wanted.glass_shadows &&
        built_.background.is_separate() == wanted.background.is_separate() &&
        built_.background.shadow_catcher == wanted.background.shadow_catcher)
      lasting.accel = world->lasting.accel;
    world.reset();
  }
  arena.execute([&] { world.emplace(scene, wanted, lasting); });
  built_ = wanted;
  if (is_placed_) camera = camera_of_size(options.width, options.height);  // refers to the world
}

std::optional<bool> PreparedPicture::sky_of_view() const {
  if (!asks_for_sky || !(glows(scene) || scene.motion.materials)) return {};
  return options.environment.automatic;
}

bool PreparedPicture::judges_view() const {
  return asks_for_sky && !kept_sky && glows(scene);
}

WorldOptions PreparedPicture::options_to_judge(bool sky) const {
  WorldOptions judged = world_options();
  judged.environment.automatic = sky;
  judged.light_groups.clear();  // they may name the sky
  return judged;
}

double PreparedPicture::dark_with(bool sky) {
  build_world(options_to_judge(sky));
  const double aspect = static_cast<double>(options.width) / options.height;
  return arena.execute([&] { return dark_share(*world, view, camera, aspect); });
}

void PreparedPicture::choose_sky() {
  if (!asks_for_sky) return;
  bool sky = kept_sky.value_or(true);
  if (judges_view()) {
    constexpr double kMaxDark = 0.5, kMinGain = 0.5;
    const double dark = dark_with(false);
    // In a closed room it would show nothing more.
    sky = dark > kMaxDark && dark_with(true) < kMinGain * dark;
  }
  options.environment.automatic = options_of_picture.environment.automatic = sky;
  build_world(world_options());
}

void PreparedPicture::describe() {
  statistics.width = region_of_picture().width();
  statistics.height = region_of_picture().height();
  statistics.threads = threads;
  statistics.isa = world->accel.isa();
  statistics.geometry_bytes = scene::geometry_bytes(scene);
  statistics.bvh_bytes = world->accel.bytes();
  statistics.texture_bytes = world->textures.bytes() + world->environment.bytes();
  statistics.light_bytes = world->lights.bytes() + world->light_arrays.bytes();
}

void PreparedPicture::choose_by_paths() {
  if (!options.choose_integrator && options.watertight != Watertight::automatic) return;
  const PilotPaths paths = arena.execute([&] { return trace_pilot_paths(*world, camera, region, options); });
  if (options.choose_integrator) {
    statistics.bounces_of_paths = paths.bounces;
    statistics.steps_in_media = paths.walk;
  }
  if (options.watertight == Watertight::automatic)
    statistics.light_behind_walls = paths.unshadowed / std::max(paths.light, 1e-30);
  options_of_picture = with_choices(options_of_picture, paths);
  options = options_of_film(options_of_picture);
  build_world(world_options());
}

AccelOptions PreparedPicture::accel_options() const {
  const AccelOptions& built = built_.acceleration;
  AccelOptions wanted{threads, options.isa, bvh_budget};
  // Until it is chosen, a world that is there serves.
  wanted.watertight = options.watertight == Watertight::automatic ? world && built.watertight
                                                                  : options.watertight == Watertight::on;
  // Splits save as much time for each sample as they take for each triangle (surface/README.md).
  const double samples = static_cast<double>(region.width()) * region.height() * options.spp;
  wanted.spatial_splits = world && built.watertight == wanted.watertight
                              ? built.spatial_splits
                              : samples > static_cast<double>(scene::count_triangles(scene));
  return wanted;
}

WorldOptions PreparedPicture::world_options() const {
  return {options.environment,   options.light_selection, accel_options(),
          options.glass_shadows, options.light_groups,    options.background};
}

void PreparedPicture::scene_moved(const CameraOptions& chosen) {
  const Clock::time_point start = Clock::now();
  if (options.integrator == Integrator::nrc && sees_by_lobe(scene)) {
    throw BadOption(
        {"integrator", "nrc", fmt::format("{} {} at this time", scene.path, kByLobe), "`integrator` path"});
  }
  if (scene.motion.any()) {
    // An earlier time that could not be shown may have left no world.
    const ReusableParts lasting = world ? world->lasting : ReusableParts{};
    world.reset();
    arena.execute([&] { world.emplace(scene, world_options(), lasting); });
  }
  set_camera(chosen);
  statistics.build_seconds = seconds_since(start);
}

void PreparedPicture::begin_frame(int frame) {
  for (RenderOptions* of : {&options, &options_of_picture})
    of->seed = hash(seed_ ^ hash(static_cast<std::uint32_t>(frame)));
}

View PreparedPicture::chosen_view(const CameraOptions& chosen) const {
  return choose_camera(scene, chosen, aspect_of(options));
}

void PreparedPicture::set_camera(const CameraOptions& chosen) {
  view = chosen_view(chosen);
  options.camera = chosen;
  std::string focus;
  if (view.lens_radius > 0.0f && !(view.focus_distance > 0.0f)) {
    view.focus_distance = distance_in_the_middle(*world, Camera(view, options.width, options.height),
                                                 options.width, options.height);
    focus = fmt::format(
        "the lens is focused at {:.4g} m, the distance at the picture's centre; `focus` {:.4g} sets the same",
        view.focus_distance, view.focus_distance);
  }
  camera = camera_of_size(options.width, options.height);
  is_placed_ = true;
  choose_sky();
  find_noisy_guides();
  statistics.warnings.clear();
  for (std::string warning :
       {denoiser_warning(chosen_denoiser), sky_warning(scene, options, asks_for_sky), left_cache_,
        world->warning, world->media.warning(), made_view(scene, options.camera, view), std::move(focus),
        world->environment.warning(), view_warning(*world, camera, options.width, options.height)}) {
    if (!warning.empty()) statistics.warnings.push_back(std::move(warning));
  }
}

void PreparedPicture::find_noisy_guides() {
  noisy_guides.reset();
  const bool filters = denoiser && options.denoise.prefilter == Prefilter::accurate;
  if (!filters && !has(options.aovs, Aov::denoising)) return;
  PixelRect r = arena.execute([&] { return renderer::noisy_guides(*world, camera, region, options); });
  noisy_guides = {r.x0 - region.x0, r.y0 - region.y0, r.x1 - region.x0, r.y1 - region.y0};
}

void PreparedPicture::change_view(const CameraOptions& chosen) {
  set_camera(chosen);
  if (!chooses_watertight_) return;
  options.watertight = options_of_picture.watertight = Watertight::automatic;
  choose_by_paths();
}

Camera PreparedPicture::camera_of_size(int width, int height) const {
  Camera made(view, width, height);
  if (scene.shutter.is_open) {
    std::vector<Camera> states;
    for (const View& moved : shutter_views(scene, options.camera, aspect_of(options), view))
      states.emplace_back(moved, width, height);
    made.open_shutter(std::move(states), scene.shutter.clock);
  }
  made.set_surroundings(std::make_shared<const Surroundings>(scene, world->media, world->accel,
                                                             world->surfaces, made.origins()));
  return made;
}

CacheMeaning PreparedPicture::cache_meaning() const {
  return {options, resolve_ao_distance(options.ao_distance, scene.bounds)};
}

SceneFingerprint PreparedPicture::fingerprint() const {
  return arena.execute([&] { return compute_scene_fingerprint(scene, options.environment); });
}

Film PreparedPicture::make_film() const {
  return {region, options.width, options.height, film_contents(options, world->light_groups.names())};
}

int PreparedPicture::samples_of_film(int spp) const {
  RenderOptions of_picture = options_of_picture;
  of_picture.spp = spp;
  return options_of_film(of_picture).spp;
}

PixelRect PreparedPicture::region_of_picture() const {
  return region_of(options_of_picture);
}

}  // namespace gatelight::renderer
