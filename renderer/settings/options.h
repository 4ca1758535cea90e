#pragma once
// The options of a picture, with their defaults. The command line binds its flags to these members.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/settings/aovs.h"
#include "renderer/settings/background_options.h"
#include "renderer/settings/cache_options.h"
#include "renderer/settings/denoise_options.h"
#include "renderer/settings/enums.h"
#include "renderer/settings/environment_options.h"
#include "renderer/settings/light_group_options.h"
#include "renderer/settings/view.h"

namespace gatelight::renderer {

class Ranks;  // distributed/ranks.h

/// The checkpoint file, from which an interrupted render resumes with bit-identical results.
struct CheckpointOptions {
  std::string file;  ///< empty: none
  double every_seconds = 60.0;
  bool resume = false;  ///< resume from `file` if it exists
};

/// An explicit view in the file's coordinates; replaces the file's cameras.
struct LookAt {
  Vec3 eye = Vec3::Zero();
  Vec3 target{0.0f, 0.0f, -1.0f};
  Vec3 up{0.0f, 1.0f, 0.0f};
};

/// Depth of field. Without an aperture, everything is sharp.
struct LensOptions {
  float aperture = 0.0f;  ///< diameter in metres, unless f_stop is set
  float f_stop = 0.0f;    ///< focal length over diameter; 0: not set
  std::string focus;      ///< metres along the view, or a node; empty: the distance at the picture's centre
  int blades = 0;         ///< corners of the aperture; 0: round
};

struct CameraOptions {
  std::string name;  ///< of a camera or its node, or an index; empty: the first, or auto-framing
  std::optional<std::size_t> index;  ///< of a camera of the file; overrides `name`, which may be ambiguous
  std::optional<LookAt> look_at;
  std::optional<float> fov_degrees;  ///< vertical; overrides the camera's
  std::optional<float> focal_mm;     ///< focal length; the longer side of the picture is 36 mm
  Projection projection = Projection::camera;
  std::optional<float> view_height;  ///< metres, of an orthographic picture
  LensOptions lens;
  Clip clip;
  float turn = 0.0f;  ///< radians by which the camera orbits its target, counter-clockwise from above
  float turn_in_shutter = 0.0f;  ///< radians of this orbit while the shutter is open
};

/// The value of spp if only another limit ends the picture.
inline constexpr int kUnlimitedSpp = 1 << 24;

/// More scattering events than Russian roulette lets a path reach.
inline constexpr int kNoDepthLimit = 1 << 30;

struct RenderOptions {
  Integrator integrator = Integrator::path;
  /// With nrc: use path if the light paths of the scene are too short for a cache to pay off
  /// (driver/scene_choices.h).
  bool choose_integrator = false;
  int width = 960;
  int height = 540;
  std::optional<std::array<int, 4>> region;  ///< x0, y0, x1, y1 in pixels, x1 and y1 excluded
  int spp = 64;                              ///< kUnlimitedSpp: as many as fit into the time limit
  /// Replaces spp if choose_integrator selects path, so that rendering takes about the same time; 0: use spp.
  int spp_of_paths = 0;
  /// Time of scouting, setup, training, passes and denoising together; 0: no limit.
  double time_limit_seconds = 0.0;
  double max_error = 0.0;  ///< rendering ends at this estimated error (relative RMS); 0: off
  /// Largest number of scattering events; 1 means emission and direct light. Without a limit, only Russian
  /// roulette ends paths.
  std::optional<int> max_depth;
  std::optional<int> max_transmission_depth;  ///< largest number of transmissions through surfaces
  int min_depth = 2;                          ///< Russian roulette starts after this many scattering events
  std::uint32_t seed = 0;
  int threads = 0;  ///< 0: as many as the machine and the control group allow
  SamplerKind sampler = SamplerKind::sobol;
  PixelFilter filter = PixelFilter::blackman_harris;
  float filter_width = 0.0f;  ///< pixels, full width; 0: the filter's own default
  MisHeuristic mis = MisHeuristic::power;
  DirectLight direct = DirectLight::mis;
  LightSelection light_selection = LightSelection::tree;
  GlassShadows glass_shadows = GlassShadows::refract;
  Watertight watertight = Watertight::on;
  float clamp = 0.0f;         ///< largest luminance of one sample; 0: off
  float ao_distance = -1.0f;  ///< metres; negative: a tenth of the scene's diagonal; infinity allowed
  DenoiseOptions denoise;
  std::vector<Aov> aovs;
  std::vector<MatteKind> cryptomattes;   ///< each once, in the order of the enumeration
  std::vector<LightGroup> light_groups;  ///< only with path: each has a layer
  NanPolicy nan_policy = NanPolicy::drop;
  std::size_t memory_limit_bytes = 0;  ///< 0: no limit; building beyond it throws OutOfMemory
  std::string isa = "auto";            ///< of Embree: auto, scalar (SSE2), avx2, avx512
  CameraOptions camera;
  EnvironmentOptions environment;
  BackgroundOptions background;
  CacheOptions cache;  ///< of nao and nrc
  CheckpointOptions checkpoint;
  Ranks* ranks = nullptr;  ///< processes that make the pictures together; null: this one alone
};

/// Values of automatic options that a renderer chose for its scene.
struct ChosenOptions {
  Integrator integrator = Integrator::path;
  Watertight watertight = Watertight::on;
};

/// Adds the name and value of each plain member that affects bits to a fingerprint, which has `add`
/// (fingerprint/deciding_options.cpp adds the others). A new member does not compile until it is named here.
template <class Texts>
void add_plain_members(Texts& texts, const RenderOptions& options) {
  [[maybe_unused]] const auto& [integrator, choose_integrator, width, height, region, spp, spp_of_paths,
                                time_limit_seconds, max_error, max_depth, max_transmission_depth, min_depth,
                                seed, threads, sampler, filter, filter_width, mis, direct, light_selection,
                                glass_shadows, watertight, clamp, ao_distance, denoise, aovs, cryptomattes,
                                light_groups, nan_policy, memory_limit_bytes, isa, camera, environment,
                                background, cache, checkpoint, processes] = options;
  texts.add("max-depth", max_depth, "none");
  texts.add("max-transmission-depth", max_transmission_depth, "none");
  texts.add("min-depth", min_depth);
  texts.add("seed", seed);
  texts.add("sampler", sampler);
  texts.add("filter", filter);
  texts.add("filter-width", filter_width);
  texts.add("mis", mis);
  texts.add("direct", direct);
  texts.add("light-selection", light_selection);
  texts.add("glass-shadows", glass_shadows);
  texts.add("watertight", watertight);
  texts.add("clamp", clamp);
}

}  // namespace gatelight::renderer
