#pragma once
// A cache in a renderer: set up for a scene, trained, asked.

#include <functional>
#include <memory>

#include "neural/trainer.h"
#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/record_batch.h"
#include "renderer/cache/triangle_counts.h"

namespace gatelight::renderer {

class CacheSession {
 public:
  /// Scouts unless a setup is given, and builds the model. World, camera and options outlive it. Runs in the
  /// caller's arena, as all that follows. A setup out of a file decides how large the model is:
  /// `expect_model` throws where the file does not hold as much, before there is memory for it. Throws
  /// neural::BadConfiguration, Unavailable.
  CacheSession(const World& world, const Camera& camera, const PixelRect& region,
               const RenderOptions& options, const CacheSetup* setup = nullptr,
               const std::function<void(const neural::Model&)>& expect_model = {});
  ~CacheSession();

  /// What training may be told and asked between steps.
  struct Watch {
    std::function<void(int done, int steps, double loss)> progress;
    std::function<bool()> stop;
    std::function<void()> after_group;  ///< of steps: a state exported here goes on with the same bits
  };
  /// Learns until `state.steps` reaches `steps`, or until stopped or out of time. Paths for the records of a
  /// group of steps are traced in one go; between groups it is asked, told and stopped. The same bits for any
  /// number of threads. Throws TrainingDiverged when the loss grows without end or answers leave all bounds.
  void train(std::uint64_t steps, const Watch& watch);
  /// The last step between groups at which training was as good as ever: where one may go back to by training
  /// anew where it diverged later. 0: there is none.
  std::uint64_t good_steps() const { return guard_.good_steps; }
  /// As before the first step.
  void start_anew();
  std::uint64_t steps() const { return steps_; }
  /// Waits for the steps that a device is still making, so that statistics and an exported state tell of the
  /// same steps. Between groups only; train ends so. Throws NumericalError as train.
  void settle();
  /// The last step, not beyond `steps`, at which training from here on is between groups.
  std::uint64_t last_group_end(std::uint64_t steps) const;

  /// All that training changes, to come back to: what is trained after that has the bits of a training that
  /// did not go beyond it in between.
  struct Bookmark {
    CacheState state;
    CacheStatistics statistics;
    RayCounts rays;
    std::vector<double> last_losses;
  };
  Bookmark bookmark() const;
  void return_to(const Bookmark& bookmark);

  /// Answers in the picture's units: radiance over reflectance (3 floats a point) or openness (1). Not finite
  /// or negative ones become zero; returns for how many points. One thread at a time.
  std::uint64_t answer(const SurfacePoints& points, std::span<float> answers) const;

  CacheState export_state() const;
  /// The setup must be this session's.
  void import_state(const CacheState& state);

  const neural::Model& model() const { return trainer_->model(); }
  const StoredSurfaces& stored() const { return stored_; }
  const PointInputs& inputs() const { return inputs_; }
  const CacheSetup& setup() const { return setup_; }
  std::span<const std::uint32_t> triangle_counts() const { return counts_.values(); }
  std::uint64_t outputs() const { return model().config.mlp.outputs; }
  /// Of scouting and training.
  RayCounts rays() const;
  /// Everything about the cache but what rendering adds.
  const CacheStatistics& statistics() const { return statistics_; }

 private:
  RecordRequest request(std::uint64_t step, std::uint64_t count) const;
  std::uint64_t group_end(std::uint64_t step) const;
  void learn(const RecordBatch& group, std::uint64_t batch);

  const RenderOptions& options_;
  CacheSetup setup_;
  std::unique_ptr<neural::Trainer> trainer_;
  PointInputs inputs_;
  StoredSurfaces stored_;
  std::unique_ptr<TrainingPoints> points_;
  std::unique_ptr<CachedPaths> paths_;
  std::unique_ptr<RecordSource> records_;
  std::uint64_t steps_ = 0;
  std::uint64_t steps_under_way_ = 0;  ///< of these
  TriangleCounts counts_;
  TrainingGuard guard_;
  std::vector<double> last_losses_;
  RayCounts scout_rays_;
  RayCounts abandoned_rays_;  ///< of steps from which it returned
  CacheStatistics statistics_;
  CacheStatistics first_statistics_;  ///< before the first step
};

}  // namespace gatelight::renderer
