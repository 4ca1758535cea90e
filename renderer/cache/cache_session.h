#pragma once
// A cache in a renderer: set up for a scene, trained and queried.

#include <functional>
#include <memory>
#include <optional>

#include "neural/trainer.h"
#include "renderer/cache/cache_state.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/cache/record_batch.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/cache/triangle_counts.h"

namespace gatelight::renderer {

class CacheSession {
 public:
  /// Scouts unless a setup is given, and builds the model. World, camera and options must outlive the
  /// session. All functions run in the caller's arena. A setup from a file decides the size of the model:
  /// `expect_model` is called before memory is allocated, and throws where the file has other tensors. Throws
  /// BadConfiguration, Unavailable.
  /// `exchange`: with the processes that train together, all of which call the same functions.
  CacheSession(const World& world, const Camera& camera, const PixelRect& region,
               const RenderOptions& options, const CacheSetup* setup = nullptr,
               const std::function<void(const neural::Model&)>& expect_model = {},
               RecordExchange exchange = {});
  /// Goes on with the cache of another view or time of the same scene, which it takes over. The samples of
  /// the picture begin anew, and the guard forgets what it has seen. As long as the cache answers for another
  /// light than the records show, paths are traced to their ends, and samples of the picture end nowhere.
  CacheSession(const World& world, const Camera& camera, const PixelRect& region,
               const RenderOptions& options, CacheSession&& earlier, RecordExchange exchange = {});
  ~CacheSession();

  /// Callbacks of training, called between groups of steps.
  struct Watch {
    std::function<void(int done, int steps, double loss)> progress;
    std::function<bool()> stop;
    std::function<void()> after_group;  ///< a state exported here resumes with the same bits
    /// Receives the paths of a group that are samples of the picture too.
    std::function<void(const RecordBatch& group)> samples;
    RecordExchange::Rebalance rebalance;
  };
  /// Trains until steps() reaches `steps`, or until it is stopped or out of time. The paths of a group of
  /// steps are traced together; the callbacks are called between groups. Gives the same bits for any number
  /// of threads. Throws TrainingDiverged when the loss or the answers grow without bound.
  void train(std::uint64_t steps, const Watch& watch);
  /// The last step at the end of a group at which the loss was near its least value. After divergence,
  /// training from the start up to it gives a good state. 0: there is none.
  std::uint64_t good_steps() const { return guard_.good_steps; }
  /// Resets to the state before the first step. `keeps_samples`: the film keeps the samples of the picture.
  void start_anew(bool keeps_samples = false);
  std::uint64_t steps() const { return steps_; }
  /// Number of the picture's samples that training has used.
  std::uint64_t samples() const { return samples_; }
  /// Waits for the steps that a device is still computing, so that statistics and an exported state belong to
  /// the same step. Call it between groups only; train() ends with it. Throws as train() does.
  void synchronize();
  /// The end of the group of steps that begins at `step`.
  std::uint64_t group_end(std::uint64_t step) const;
  /// The last step, at most `steps`, that lies between groups of the training from here on.
  std::uint64_t last_group_end(std::uint64_t steps) const;

  /// All state that training changes. After return_to(), training gives the same bits as if it had not
  /// continued.
  struct Snapshot {
    CacheState state;
    CacheStatistics statistics;
    RecordExchange::Share share;
    RayCounts rays;
    std::vector<double> last_losses;
  };
  Snapshot snapshot() const;
  void return_to(const Snapshot& snapshot);

  /// Answers in the picture's units: radiance over reflectance (3 floats per point) or transmittance of
  /// occlusion rays (1). Negative answers and those that are not finite become zero; returns the number of
  /// such points.
  std::uint64_t answer(const SurfacePoints& points, std::span<float> answers) const;

  CacheState export_state() const;
  /// The state's setup must be this session's.
  void import_state(const CacheState& state);

  /// Of a cache that was taken over: light_change() of the first group of records, before it learned them.
  double light_change() const { return light_change_.value_or(0.0); }
  /// Shortens the memory of the optimiser to some steps: rates of learning, and averages, are as after them.
  void forget_beyond(std::uint32_t steps);

  const neural::Model& model() const { return trainer_->model(); }
  const neural::TrainingOptions& learning() const { return trainer_->options(); }
  const StoredSurfaces& stored() const { return stored_; }
  const PointInputs& inputs() const { return inputs_; }
  const CacheSetup& setup() const { return setup_; }
  std::span<const std::uint32_t> triangle_counts() const { return counts_.values(); }
  std::uint64_t outputs() const { return model().config.mlp.outputs; }
  /// Whether several threads may call answer() at a time.
  bool answers_threads() const { return trainer_->backend().answers_threads(); }
  /// Rays of scouting and training that were counted here.
  RayCounts rays() const;
  const RecordExchange& exchange() const { return exchange_; }
  /// All statistics of the cache except those of rendering.
  const CacheStatistics& statistics() const { return statistics_; }

 private:
  /// A group of steps whose records are being traced, exchanged or learned.
  struct Group {
    RecordRequest request;
    RecordBatch records;
    RankWork work;   ///< done here
    RayCounts rays;  ///< traced here
    RecordExchange::Coming coming;
    std::uint64_t steps() const { return request.batches; }
    std::uint64_t samples() const { return records.starts.samples.size(); }
  };
  /// Makes the parts that refer to a world and its view.
  void connect(const World& world, const Camera& camera, const PixelRect& region);
  RecordRequest request(std::uint64_t step, std::uint64_t count, std::uint64_t first_sample) const;
  void begin(std::uint64_t step, std::uint64_t count, std::uint64_t first_sample, Group& group);
  /// Traces a group that was begun while the cache learns from another; both may be null.
  void trace_and_learn(Group* next, Group* learning, const Watch& watch, Team& team);
  void train(std::uint64_t steps, const Watch& watch, Team& team);
  void finish(Group& group);
  /// Takes the records that are traced elsewhere.
  void receive(Group& group, const Watch& watch);
  /// Makes the steps of a group: one by one, or all at once where a device computes them meanwhile.
  void learn(const RecordBatch& group, Team& team);
  /// Compares records that are not learned yet with the answers.
  void look_at_light(const RecordBatch& group);
  /// answer() in any precision. No light where the world has none, which a network only comes near to.
  std::uint64_t ask(neural::QueryPrecision precision, const SurfacePoints& points,
                    std::span<float> answers) const;
  void look_at_answers(const RecordBatch& group);

  const RenderOptions& options_;
  const scene::Scene* scene_ = nullptr;
  bool dark_ = false;  ///< there is no light to learn
  RecordExchange exchange_;
  CacheSetup setup_;
  std::unique_ptr<neural::Trainer> trainer_;
  PointInputs inputs_;
  StoredSurfaces stored_;
  std::unique_ptr<TrainingPoints> points_;
  std::unique_ptr<CachedPaths> paths_;
  std::unique_ptr<RecordSource> records_;
  std::uint64_t steps_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t steps_under_way_ = 0;  ///< part of steps_: submitted to a device, not finished
  TriangleCounts counts_;
  TrainingGuard guard_;
  bool fits_ = true;  ///< the cache has learned the present light, as far as its records tell
  std::optional<double> light_change_;
  std::vector<double> last_losses_;
  RayCounts scout_rays_;
  RayCounts unlearned_rays_;  ///< of a group that is traced and not learned yet
  RayCounts abandoned_rays_;  ///< of steps that return_to() undid
  CacheStatistics statistics_;
  CacheStatistics first_statistics_;  ///< before the first step
};

}  // namespace gatelight::renderer
