#pragma once
// All that is chosen and built before the work on a picture begins.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <memory>
#include <optional>

#include "renderer/cache/cache_file.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/driver/chosen_denoiser.h"
#include "renderer/film/camera.h"
#include "renderer/film/film.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/film/scale_down.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "renderer/settings/view.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Constant while a picture is made.
struct PreparedPicture {
  /// Throws the exceptions of Renderer's constructor.
  PreparedPicture(const scene::Scene& scene_in, const RenderOptions& options_in);

  /// The pictures from now on have other options. Builds only the parts of the world that depend on what has
  /// changed. Throws the exceptions of the constructor; call it again then, with options that it takes.
  void set_options(const RenderOptions& chosen);
  /// Changes the view, and the warnings about it. Builds the lights again where the soft sky comes or goes.
  void set_camera(const CameraOptions& chosen);
  /// The same, and chooses again what Watertight::automatic left to the view.
  void change_view(const CameraOptions& chosen);
  /// The scene shows another time.
  void scene_moved(const CameraOptions& camera);
  /// The picture is a frame of an animation, with random numbers of its own.
  void begin_frame(int frame);

  /// The view of the present scene.
  View chosen_view(const CameraOptions& chosen) const;
  /// Whether the soft sky lights the view; nothing where no view of the scene can change that.
  std::optional<bool> sky_of_view() const;
  /// An empty film.
  Film make_film() const;
  /// Samples per pixel of the film for those of the picture.
  int samples_of_film(int spp) const;
  /// In the picture's own pixels.
  PixelRect region_of_picture() const;
  /// The view for a picture of another size, with the shutter of the scene.
  Camera camera_of_size(int width, int height) const;
  CacheMeaning cache_meaning() const;
  SceneFingerprint fingerprint() const;  ///< of the scene with its environment

  const scene::Scene& scene;
  ChosenDenoiser chosen_denoiser;
  RenderOptions options_of_picture;  ///< with automatic values chosen
  RenderOptions options;             ///< of the film, which may be larger
  int threads;
  tbb::global_control control;
  mutable tbb::task_arena arena;  ///< runs all work, which doesn't change the picture
  PixelRect region;               ///< of the film
  View view;
  Camera camera{view, 1, 1};
  FilterSampler filter{PixelFilter::box, 1.0f};
  ScaleDown scale{1, PixelFilter::box, 1.0f};  ///< from the film to the picture
  std::unique_ptr<Denoiser> denoiser;          ///< null: the picture is as traced
  std::optional<PixelRect> noisy_guides;       ///< NoisyPicture::noisy_guides of the view
  std::optional<World> world;                  ///< empty only during construction
  /// Whether the options ask for a soft sky that the scene may need: it has no lights but what glows.
  bool asks_for_sky = false;
  std::optional<bool> kept_sky;  ///< whether the soft sky lights all views and times; empty: each by itself
  bool steps_chosen = false;     ///< training steps: from the picture's pixels and samples
  std::size_t bvh_budget = 0;    ///< bytes; 0: no limit
  RenderStatistics statistics;   ///< of building, with its warnings

 private:
  void choose_options(const RenderOptions& chosen);
  /// Chooses plain paths where a cache cannot hold what the scene shows.
  void leave_cache(RenderOptions& next);
  void build_world(const WorldOptions& wanted);
  /// Whether the view decides about the soft sky.
  bool judges_view() const;
  WorldOptions options_to_judge(bool sky) const;
  /// dark_share() of the view, by what glows alone or with the soft sky.
  double dark_with(bool sky);
  /// Lights the world with the soft sky where the view needs it.
  void choose_sky();
  void find_noisy_guides();
  /// Fills in the statistics of the world.
  void describe();
  AccelOptions accel_options() const;
  WorldOptions world_options() const;
  /// Applies RenderOptions::choose_integrator, for the first view, and Watertight::automatic.
  void choose_by_paths();

  WorldOptions built_;      ///< of the present world
  std::uint32_t seed_ = 0;  ///< of the whole animation
  bool chooses_watertight_ = false;
  bool is_placed_ = false;  ///< the camera is
  std::string left_cache_;  ///< the warning of leave_cache()
};

}  // namespace gatelight::renderer
