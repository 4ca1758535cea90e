#include "neural/cpu/cpu_backend.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/clock.h"
#include "base/errors.h"
#include "base/parallel/loops.h"
#include "base/parallel/team.h"
#include "base/platform/flush_denormals.h"
#include "neural/cpu/adam_table.h"
#include "neural/cpu/feature_store.h"
#include "neural/cpu/kernel_model.h"
#include "neural/cpu/network_store.h"
#include "neural/cpu/node_references.h"
#include "neural/learning/start_mean.h"
#include "neural/model/checks.h"

namespace gatelight::neural::cpu {

namespace {

// A thread's memory for one bucket of nodes. All but the references is zero between buckets.
struct BucketScratch {
  HugeBuffer<KernelReference> references;
  HugeBuffer<float> sums;
  HugeBuffer<std::uint64_t> touched;
  HugeBuffer<std::uint32_t> touched_list, steps;
};

class CpuBackend final : public Backend {
 public:
  CpuBackend(std::shared_ptr<const Model> model, const TrainingOptions& options, simd::Isa isa)
      : model_(std::move(model)),
        options_(options),
        isa_(isa),
        table_(kernel_table(isa)),
        layout_(model_->parameters),
        encoder_(kernel_encoder(*model_)),
        features_(*model_, options_),
        network_(*model_, options_),
        adam_table_(adam_table(options_)) {
    if (options_.counts_triangles()) {
      triangle_steps_.assign(model_->gate.triangle_count, 0);
      triangle_stamps_.assign(triangle_steps_.size(), 0);
    }
  }

  StepStatistics train(const TrainingBatch& batch) override;
  StepStatistics train(const TrainingBatch& batch, Team& team) override;
  bool answers_threads() const override { return true; }
  void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const override;
  ModelState export_state() const override;
  void import_state(const ModelState& state) override;

  std::string name() const override { return fmt::format("cpu {}", simd::isa_name(isa_)); }
  std::uint64_t parameter_bytes() const override {
    return features_.parameter_bytes() + layout_.network_count() * sizeof(float);
  }
  std::uint64_t optimizer_bytes() const override {
    return features_.optimizer_bytes() + 3 * layout_.network_count() * sizeof(float) +
           triangle_steps_.size() * sizeof(std::uint32_t);
  }

 private:
  void start_output_at_mean(const TrainingBatch& batch);
  StepStatistics run_network(const TrainingBatch& batch, Team& team);
  KernelFeatureUpdate feature_update(float scale, const std::uint32_t* record_steps) const;
  void update_buckets(std::uint32_t begin, std::uint32_t end, KernelFeatureUpdate u);
  void update(float scale, const TrainingBatch& batch, Team& team, StepStatistics& statistics);
  std::vector<std::uint32_t> count_triangles(const TrainingBatch& batch);
  float* scratch(std::uint64_t floats) const;

  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  simd::Isa isa_;
  const KernelTable& table_;
  const ParameterLayout& layout_;
  KernelEncoder encoder_;
  FeatureStore features_;
  NetworkStore network_;
  std::vector<KernelAdamStep> adam_table_;
  std::uint64_t steps_ = 0;
  std::vector<std::uint32_t> triangle_steps_;
  std::vector<std::uint64_t> triangle_stamps_;

  // Memory of a step.
  Buckets buckets_;
  NodeReferences references_;
  HugeBuffer<float> feature_gradients_;
  HugeBuffer<float> chunk_gradients_;  // [chunk][packed layout]
  std::vector<std::uint8_t> accepted_;
  std::vector<KernelChunkStatistics> chunk_statistics_;
  mutable tbb::enumerable_thread_specific<HugeBuffer<float>> scratch_;
  tbb::enumerable_thread_specific<BucketScratch> bucket_scratch_;
};

float* CpuBackend::scratch(std::uint64_t floats) const {
  HugeBuffer<float>& mine = scratch_.local();
  reserve(mine, floats);
  return mine.data();
}

// Sets the output biases, so that the network starts with the right brightness.
void CpuBackend::start_output_at_mean(const TrainingBatch& batch) {
  const std::vector<double> means = start_mean(*model_, batch, options_.max_target);
  if (!means.empty()) network_.set_output_biases(means);
}

// Encode, forward, loss and backward of all chunks, whose references are sorted.
StepStatistics CpuBackend::run_network(const TrainingBatch& batch, Team& team) {
  const auto records = static_cast<std::uint32_t>(batch.points.size);
  const KernelPoints points = kernel_points(*model_, batch.points);
  const Chunks chunks(records);
  KernelEncoder encoder = encoder_;
  features_.set_training_view(encoder);
  const std::uint32_t slots = encoder.levels * encoder.nodes_per_level;
  buckets_ = make_buckets(layout_.node_count, chunks.tiles_of_chunk * kTile * slots);
  references_.start(chunks, buckets_, slots);
  reserve(feature_gradients_, std::size_t{records} * layout_.feature_inputs);
  reserve(chunk_gradients_, chunks.count * network_.size());
  if (!triangle_steps_.empty()) accepted_.resize(records);
  chunk_statistics_.resize(chunks.count);
  const std::uint64_t scratch_floats = table_.scratch_floats(encoder_, network_.kernel());

  team.for_each(chunks.count, [&](std::uint32_t begin, std::uint32_t end) {
    const FlushDenormals flush;
    KernelTraining t = {};
    t.encoder = &encoder;
    t.network = &network_.kernel();
    t.points = points;
    t.targets = batch.targets.data();
    t.begin = chunks.begin(begin);
    t.end = chunks.end(end - 1);
    t.chunk_tiles = chunks.tiles_of_chunk;
    t.relative_loss = options_.loss == Loss::relative_l2 ? 1 : 0;
    t.max_target = options_.max_target;
    t.scratch = scratch(scratch_floats);
    t.nodes = references_.nodes();
    t.weights = references_.weights();
    t.feature_gradients = feature_gradients_.data();
    t.accepted = triangle_steps_.empty() ? nullptr : accepted_.data();
    t.gradients = chunk_gradients_.data() + begin * network_.size();
    t.gradient_size = network_.size();
    t.statistics = &chunk_statistics_[begin];
    table_.train(t);
    for (std::uint32_t chunk = begin; chunk < end; ++chunk)
      references_.sort(chunk, encoder.nodes_per_level, layout_.features, layout_.feature_inputs);
  });

  StepStatistics statistics;
  double loss = 0.0;
  for (const KernelChunkStatistics& chunk : chunk_statistics_) {
    loss += chunk.loss;
    statistics.records += chunk.accepted;
    statistics.rejected += chunk.rejected;
    statistics.unstored += chunk.unstored;
    statistics.clipped += chunk.clipped;
  }
  if (statistics.records > 0)
    statistics.loss = loss / (static_cast<double>(statistics.records) * model_->config.mlp.outputs);
  return statistics;
}

// Increments the count of each triangle with an accepted record, once per step. Returns the count of each
// record's triangle.
std::vector<std::uint32_t> CpuBackend::count_triangles(const TrainingBatch& batch) {
  std::vector<std::uint32_t> record_steps(batch.points.size, 0);
  if (triangle_steps_.empty()) return record_steps;
  const auto number = [&](std::size_t i) {
    return model_->gate.surfaces[batch.points.surfaces[i]].first_triangle + batch.points.triangles[i];
  };
  for (std::size_t i = 0; i < batch.points.size; ++i) {
    if (accepted_[i] == 0) continue;
    const std::uint32_t triangle = number(i);
    if (triangle_stamps_[triangle] != steps_) {
      triangle_stamps_[triangle] = steps_;
      if (triangle_steps_[triangle] != std::numeric_limits<std::uint32_t>::max()) ++triangle_steps_[triangle];
    }
    record_steps[i] = triangle_steps_[triangle];
  }
  return record_steps;
}

// What all buckets of a step have in common.
KernelFeatureUpdate CpuBackend::feature_update(float scale, const std::uint32_t* record_steps) const {
  KernelFeatureUpdate u = {};
  u.features = layout_.features;
  u.feature_inputs = layout_.feature_inputs;
  u.feature_gradients = feature_gradients_.data();
  u.record_steps = record_steps;
  u.dense = options_.update == FeatureUpdate::dense ? 1 : 0;
  u.adam = {options_.adam.beta1, options_.adam.beta2, scale};
  u.steps = adam_table_.data();
  u.step_count = kAdamTableSteps;
  u.late_step = [](const void* context, std::uint64_t t) {
    return adam_step(*static_cast<const TrainingOptions*>(context), t);
  };
  u.late_context = &options_;
  u.dense_step = adam_step(options_, steps_);
  features_.set_update_view(u);
  return u;
}

// Sums the references of some buckets and updates their nodes.
void CpuBackend::update_buckets(std::uint32_t begin, std::uint32_t end, KernelFeatureUpdate u) {
  BucketScratch& mine = bucket_scratch_.local();
  const std::size_t bucket_nodes = std::size_t{1} << buckets_.shift;
  reserve(mine.sums, bucket_nodes * layout_.features);
  reserve(mine.touched, bucket_nodes / 64 + 1);
  reserve(mine.touched_list, bucket_nodes);
  reserve(mine.steps, bucket_nodes);
  u.sums = mine.sums.data();
  u.touched = mine.touched.data();
  u.touched_list = mine.touched_list.data();
  u.step_scratch = mine.steps.data();
  for (std::uint32_t bucket = begin; bucket < end; ++bucket) {
    u.reference_count = references_.size(bucket);
    if (u.reference_count == 0 && u.dense == 0) continue;
    reserve(mine.references, u.reference_count);
    references_.copy(bucket, mine.references.data());
    if (bucket + 1 < end) references_.prefetch(bucket + 1);
    u.references = mine.references.data();
    u.first_node = buckets_.first(bucket);
    u.node_count = buckets_.size(bucket);
    table_.update_features(u);
  }
}

// Updates the network and the features, in one loop.
void CpuBackend::update(float scale, const TrainingBatch& batch, Team& team, StepStatistics& statistics) {
  constexpr std::uint32_t kSlice = 256;  // parameters of the network
  const bool per_triangle =
      options_.feature_step == FeatureStep::per_triangle && options_.update != FeatureUpdate::dense;
  std::vector<std::uint32_t> record_steps;
  if (!triangle_steps_.empty()) record_steps = count_triangles(batch);
  const KernelFeatureUpdate of_features = feature_update(scale, per_triangle ? record_steps.data() : nullptr);
  const auto slices = static_cast<std::uint32_t>((network_.size() + kSlice - 1) / kSlice);
  std::atomic<std::uint64_t> touched = 0, skipped = 0;
  team.for_each(slices + buckets_.count, [&](std::uint32_t begin, std::uint32_t end) {
    const FlushDenormals flush;
    std::uint64_t touched_here = 0, skipped_here = 0;
    if (begin < slices)
      skipped_here += network_.update(
          std::uint64_t{begin} * kSlice,
          std::min(std::uint64_t{std::min(end, slices)} * kSlice, network_.size()), chunk_gradients_.data(),
          static_cast<std::uint32_t>(chunk_statistics_.size()), scale, of_features.dense_step);
    if (end > slices) {
      KernelFeatureUpdate u = of_features;
      u.touched_count = &touched_here;
      u.skipped_count = &skipped_here;
      update_buckets(std::max(begin, slices) - slices, end - slices, u);
    }
    touched += touched_here;
    skipped += skipped_here;
  });
  network_.updated();
  statistics.touched_nodes = touched;
  statistics.skipped_updates = skipped;
}

StepStatistics CpuBackend::train(const TrainingBatch& batch) {
  StepStatistics statistics;
  Team::run([&](Team& team) { statistics = train(batch, team); });
  return statistics;
}

StepStatistics CpuBackend::train(const TrainingBatch& batch, Team& team) {
  check_batch(*model_, batch);
  const FlushDenormals flush;
  // References and offsets of gradients have 32 bits.
  const std::uint64_t most =
      std::numeric_limits<std::uint32_t>::max() / std::max(4 * layout_.inputs, model_->nodes_per_point());
  if (batch.points.size > most)
    throw BadConfiguration(
        {"batch", fmt::format("{}", batch.points.size), "", fmt::format("at most {}", most)});
  const Clock::time_point start = Clock::now();
  if (steps_ == 0 && layout_.biases && options_.start_at_mean) start_output_at_mean(batch);

  StepStatistics statistics = run_network(batch, team);
  statistics.seconds_network = seconds_since(start);
  if (statistics.records > 0) {
    ++steps_;
    const double scale = 1.0 / (static_cast<double>(statistics.records) * model_->config.mlp.outputs);
    const Clock::time_point updating = Clock::now();
    update(static_cast<float>(scale), batch, team, statistics);
    statistics.seconds_update = seconds_since(updating);
  }
  statistics.seconds = seconds_since(start);
  return statistics;
}

void CpuBackend::query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
  check_batch(*model_, batch, out);
  KernelEncoder encoder = encoder_;
  features_.set_query_view(encoder, options.averaged);
  const bool bf16 = options.precision == QueryPrecision::bf16;
  const KernelNetwork& network = network_.query_kernel(options.averaged, bf16);
  const KernelPoints points = kernel_points(*model_, batch);
  const std::uint64_t scratch_floats = table_.scratch_floats(encoder, network);
  constexpr std::size_t kMax = 64, kFewest = 4, kChunks = 64;
  const std::size_t tiles = std::clamp(batch.size / (kTile * kChunks), kFewest, kMax);
  for_each_range(batch.size, tiles * kTile, [&](std::size_t begin, std::size_t end) {
    const FlushDenormals flush;
    KernelQuery q = {};
    q.encoder = &encoder;
    q.network = &network;
    q.points = points;
    q.begin = begin;
    q.end = end;
    q.bf16 = bf16 ? 1 : 0;
    q.range = static_cast<std::uint32_t>(options.range);
    q.scratch = scratch(scratch_floats);
    q.out = out.data();
    table_.query(q);
  });
}

ModelState CpuBackend::export_state() const {
  ModelState state;
  features_.export_to(state);
  network_.export_to(state);
  state.triangle_steps = triangle_steps_;
  state.steps = steps_;
  return state;
}

void CpuBackend::import_state(const ModelState& state) {
  check_state(*model_, options_, state);
  check_state_numbers(state);
  // Allocate first, so that nothing is changed if memory runs out.
  NetworkStore::Arrays network = network_.arrays_of(state);
  std::vector<std::uint32_t> triangle_steps = state.triangle_steps;
  std::vector<std::uint64_t> stamps(triangle_steps.size(), 0);
  network_.set(network);
  triangle_steps_ = std::move(triangle_steps);
  triangle_stamps_ = std::move(stamps);
  features_.import_from(state);
  steps_ = state.steps;
}

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(std::shared_ptr<const Model> model, const TrainingOptions& options,
                                          std::optional<simd::Isa> isa) {
  check_options(*model, options);
  // Kernels gather the words of levels with signed 32-bit offsets.
  constexpr std::size_t kMaxLevels = (std::size_t{1} << 31) / (sizeof(GateSurfaceLevel) / 4);
  if (model->gate.levels.size() >= kMaxLevels)
    throw BadConfiguration(fmt::format("levels of all surfaces: {}, expected less than {}",
                                       model->gate.levels.size(), kMaxLevels));
  return std::make_unique<CpuBackend>(std::move(model), options, simd::select_isa(isa));
}

}  // namespace gatelight::neural::cpu
