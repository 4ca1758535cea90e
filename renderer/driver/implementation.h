#pragma once
// Renderer's members, and the steps that a picture and a series of pictures share.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/clock.h"
#include "renderer/cache/cache_session.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/distributed/ranks.h"
#include "renderer/distributed/shares.h"
#include "renderer/driver/checkpoint.h"
#include "renderer/driver/chosen_denoiser.h"
#include "renderer/driver/film_exchange.h"
#include "renderer/driver/finished_picture.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/film/rank_tiles.h"
#include "renderer/film/scale_down.h"
#include "renderer/film/tiles.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/render.h"
#include "renderer/transport/pass.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// A cache in training. Integrators without a cache have no session.
struct Training {
  std::unique_ptr<CacheSession> session;
  std::uint64_t first_step = 0;  ///< the steps of a loaded cache come before
  int steps = 0;                 ///< wanted for the next picture
  int all_steps = 0;             ///< wanted for the last one
  bool chosen = false;           ///< steps chosen from the picture's pixels and samples
  bool complete = false;
  bool stopped = false;  ///< by the caller
  /// Training should end here, with a group of steps.
  Clock::time_point end = Clock::time_point::max();
  std::string diverged;  ///< why training returned to its last good state; else empty
  SampleCounts counts;   ///< of the picture's samples that trained it, in this run

  /// Samples of the picture that its film has from training. A loaded cache was trained with another picture.
  std::uint64_t samples() const { return session && first_step == 0 ? session->samples() : 0; }
};

struct Renderer::Implementation {
  Implementation(const scene::Scene& scene_in, const RenderOptions& options_in, Ranks& ranks_in);

  /// Applies RenderOptions::choose_integrator, with the first view.
  void choose_integrator();
  View chosen_view(const CameraOptions& chosen) const;
  /// Chooses the view, and puts its warnings into the statistics.
  void look_through(const CameraOptions& chosen);
  /// The fingerprint of the scene with its environment.
  SceneFingerprint scene_fingerprint();
  CheckpointIdentity identity(const SceneFingerprint& fingerprint) const;
  /// Starts from the checkpoint or the cache file where there is one, else from a new cache.
  Training begin_training(Checkpoint* found, const SceneFingerprint& fingerprint, const Callbacks& callbacks);
  /// Trains up to training.steps. The film gets the paths that are samples of the picture.
  void train(Training& training, Film& film, const Callbacks& callbacks,
             const std::function<void()>& after_group);
  /// After training diverged: returns to the last good state by training up to it again. So normal training
  /// costs nothing extra. False where there is no good state. Film and `earlier` are those of that state.
  bool return_to_good(Training& training, Film& film, Checkpoint* found, RenderStatistics& earlier,
                      const Callbacks& callbacks);
  /// The finished picture of a film, with its view. Rank 0 gets it.
  /// `stopped`: the caller has stopped the samples, and not yet the denoiser.
  FinishedPicture finish(Film& film, const Callbacks& callbacks, bool stopped);
  /// The estimated error of the picture; empty where it is unknown. All ranks get it.
  std::optional<double> estimate_error(Film& film);
  Finishing finishing(double samples_per_pixel, DenoiseProgress progress) const;
  /// Mean over all pixels, of all ranks.
  double samples_per_pixel(const Film& film) const;
  /// The exact film, at rank 0.
  void gather(Film& film) { gather_film(film, tiles, shares, ranks); }
  /// Distributes the tiles anew where some rank took much longer than others.
  void rebalance(Film& film, const std::vector<RankWork>& measured);
  /// Adds the denoiser's statistics of a finished picture.
  void add_statistics(const FinishedPicture& finished);
  /// Expected time of finish() under a time limit: for the denoiser, and for the shadow catchers.
  double expect_denoise_seconds();
  double expect_shadow_seconds();
  CaughtShadows caught_shadows(double samples_per_pixel) const;
  /// Convert samples per pixel of the picture to those of the film, and back.
  int samples_of_film(int spp) const;
  int samples_of_picture(int of_film) const { return of_film * options.denoise.parts(); }
  /// The region of the picture, in its own pixels.
  PixelRect region_of_picture() const;
  /// The layers of options.cryptomattes; the statistics get the time.
  Cryptomattes cryptomattes();
  Film make_film() const;
  std::unique_ptr<Pass> make_pass(Training& training);
  /// Number of samples in the tiles of this rank.
  std::uint64_t samples_of_rank(const Film& film) const;
  /// Sums up the counts of all ranks, and keeps those of each rank.
  void add_other_ranks(RenderStatistics& statistics, const Training& training) const;
  /// Statistics of this run and of the earlier ones, of all ranks.
  RenderStatistics sum_up(int spp, double seconds, const Film& film, const Pass* pass,
                          const Training& training, const RenderStatistics& earlier) const;

  class PictureRun;
  bool render_step_series(const std::vector<int>& train_steps, const SeriesPicture& picture,
                          const Callbacks& callbacks);
  bool render_sample_series(const std::vector<int>& spp, const SeriesPicture& picture,
                            const Callbacks& callbacks);

  const scene::Scene& scene;
  ChosenDenoiser chosen_denoiser;
  RenderOptions picture_options;    ///< of the picture, with automatic values chosen
  RenderOptions options;  ///< of the film, which may be larger
  Ranks& ranks;
  int threads;
  tbb::global_control control;
  tbb::task_arena arena;
  PixelRect region;
  TileGrid tiles;
  std::vector<double> threads_of_ranks;
  Shares shares;  ///< of the tiles
  TileGrid own;   ///< this rank's
  RankTiles rank_tiles{ranks, tiles, shares};
  View view;
  Camera camera{view, 1, 1};
  FilterSampler filter;
  ScaleDown scale;  ///< from the film to the picture
  std::size_t budget;
  std::unique_ptr<Denoiser> denoiser;  ///< null: the picture is as traced
  std::optional<World> world;
  Ranks::Traffic traffic_before;           ///< before the picture
  Clock::time_point begin = Clock::now();  ///< of the picture
  bool steps_chosen = false;               ///< training steps: from the picture's pixels and samples
  RenderStatistics statistics;
};

}  // namespace gatelight::renderer
