#pragma once
// Renderer's members, and the steps that a picture and a series of pictures share.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "renderer/cache/cache_session.h"
#include "renderer/film/camera.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/film/rank_tiles.h"
#include "renderer/film/tiles.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/machine/clock.h"
#include "renderer/ranks/ranks.h"
#include "renderer/ranks/shares.h"
#include "renderer/render.h"
#include "renderer/run/checkpoint.h"
#include "renderer/run/film_exchange.h"
#include "renderer/run/finished_picture.h"
#include "renderer/run/sample_loop.h"
#include "renderer/transport/pass.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// A cache in training. Integrators without a cache have no session.
struct Training {
  std::unique_ptr<CacheSession> session;
  std::uint64_t first_step = 0;  ///< the steps of a loaded cache come before
  int steps = 0;                 ///< wanted for the next picture
  int all_steps = 0;             ///< of the last one
  bool chosen = false;           ///< by the picture's pixels and samples
  bool complete = false;
  bool stopped = false;  ///< by the caller
  /// Training should end here, with a group of steps.
  Clock::time_point end = Clock::time_point::max();
  std::string diverged;  ///< why training returned to its last good state; else empty
  SampleCounts counts;   ///< of the picture's samples that it learned from, in this run

  /// Samples of the picture that its film has from training. A loaded cache learned from another picture.
  std::uint64_t samples() const { return session && first_step == 0 ? session->samples() : 0; }
};

struct Renderer::Implementation {
  Implementation(const scene::Scene& scene_in, const RenderOptions& options_in, Ranks& ranks_in);

  View chosen_view(const CameraOptions& chosen) const;
  /// Chooses the view, and says in the statistics what is to be told of it.
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
  FinishedPicture finish(Film& film);
  /// The film follows the density of its finished picture from now on. `known`: its reconstruction, if it is,
  /// at rank 0. Returns the seconds that this took.
  double adapt_density(Film& film, const Reconstruction* known);
  /// Of all pixels, at whatever rank.
  double samples_per_pixel(const Film& film) const;
  /// The exact film, at rank 0.
  void gather(Film& film) { gather_film(film, tiles, shares, ranks); }
  /// Deals the tiles anew where some rank took much longer than others.
  void rebalance(Film& film, const std::vector<RankWork>& measured);
  /// What a finished picture tells goes into the statistics. `seconds`: of all reconstruction.
  void tell(const FinishedPicture& finished, double seconds);
  /// What finish() is expected to take for the catchers of shadows under a time limit.
  double expect_shadow_seconds();
  // For finished_picture().
  SeenLight smoother_edges(double samples_per_pixel) const;
  CaughtShadows caught_shadows(double samples_per_pixel) const;
  /// The first row of each rank, where they share what costs alike everywhere; then the number of rows.
  std::vector<int> rows_of_ranks() const;
  /// Of the picture, that the rank with most rows finishes, with their margin.
  double share_of_rows() const;
  /// The rows that a rank needs to finish its own: first <= y < end, from the top of the region.
  std::pair<int, int> rows_with_margin(int rank) const;
  /// The rows that this rank finishes.
  SharedRows shared_rows() const;
  /// What all samples say of them and their margin.
  Picture sampled_rows(const Film& film);
  /// The layers of options.cryptomattes; the statistics get the time.
  Cryptomattes cryptomattes();
  Film make_film() const;
  std::unique_ptr<Pass> make_pass(Training& training);
  /// Of the tiles of this rank.
  std::uint64_t samples_of_rank(const Film& film) const;
  /// What each rank counts on its own is summed up, and told by rank.
  void add_other_ranks(RenderStatistics& statistics, const Training& training) const;
  /// Statistics of this run and of the earlier ones, of all ranks.
  RenderStatistics sum_up(int spp, double seconds, const Film& film, const Pass* pass,
                          const Training& training, const RenderStatistics& earlier) const;

  /// One pass, up to `goal` samples, after a new density where one is due. Returns the seconds of the
  /// density.
  double run_adaptive_pass(SampleLoop& loop, Film& film, int goal);

  class PictureRun;
  bool render_step_series(const std::vector<int>& train_steps, const SeriesPicture& picture,
                          const Callbacks& callbacks);
  bool render_sample_series(const std::vector<int>& spp, const SeriesPicture& picture,
                            const Callbacks& callbacks);

  const scene::Scene& scene;
  RenderOptions options;
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
  std::size_t budget;
  std::optional<World> world;
  Ranks::Traffic traffic_before;           ///< before the picture
  Clock::time_point begin = Clock::now();  ///< of the picture
  bool steps_chosen = false;               ///< of training, by the picture's pixels and samples
  RenderStatistics statistics;
};

}  // namespace gatelight::renderer
