#include "neural/cpu/cpu_backend.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>

#include "base/clock.h"
#include "base/errors.h"
#include "base/parallel/loops.h"
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

// A thread's memory for one bucket of nodes.
struct BucketScratch {
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
        adam_table_(adam_table(options_)),
        buckets_(make_buckets(layout_.node_count)) {
    if (options_.counts_triangles()) {
      triangle_steps_.assign(model_->gate.triangle_count, 0);
      triangle_stamps_.assign(triangle_steps_.size(), 0);
    }
  }

  StepStatistics train(const TrainingBatch& batch) override;
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

  NetworkPass network_pass(std::span<const float> inputs, std::span<const float> targets);

 private:
  void start_output_at_mean(const TrainingBatch& batch);
  StepStatistics run_network(const KernelPoints& points, const float* targets, const float* inputs,
                             std::uint32_t records, bool references);
  void update_features(double scale, const TrainingBatch& batch, StepStatistics& statistics);
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
  HugeBuffer<float> chunk_gradients_;
  std::vector<std::uint8_t> accepted_;
  std::vector<KernelChunkStatistics> chunk_statistics_;
  std::vector<float> packed_gradient_;
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

StepStatistics CpuBackend::run_network(const KernelPoints& points, const float* targets, const float* inputs,
                                       std::uint32_t records, bool references) {
  const Chunks chunks{records};
  KernelEncoder encoder = encoder_;
  features_.set_training_view(encoder);
  if (!references) {
    encoder.encoding = KernelEncoding::none;
    encoder.levels = 0;
    encoder.auxiliary_count = 0;
  }
  references_.start(chunks, buckets_, encoder.levels * encoder.nodes_per_level);
  reserve(feature_gradients_, std::size_t{records} * layout_.feature_inputs);
  const std::uint64_t gradient_size = network_.packed().gradient_size();
  reserve(chunk_gradients_, chunks.count() * gradient_size);
  if (!triangle_steps_.empty()) accepted_.resize(records);
  chunk_statistics_.assign(chunks.count(), {});
  const std::uint64_t scratch_floats = table_.scratch_floats(encoder_, network_.packed().kernel());

  for_each(chunks.count(), [&](std::size_t number) {
    const auto chunk = static_cast<std::uint32_t>(number);
    const FlushDenormals flush;
    float* gradients = chunk_gradients_.data() + chunk * gradient_size;
    std::fill_n(gradients, gradient_size, 0.0f);
    KernelTraining t = {};
    t.encoder = &encoder;
    t.network = &network_.packed().kernel();
    t.points = points;
    t.targets = targets;
    t.begin = chunks.begin(chunk);
    t.end = chunks.end(chunk);
    t.relative_loss = options_.loss == Loss::relative_l2 ? 1 : 0;
    t.max_target = options_.max_target;
    t.scratch = scratch(scratch_floats);
    t.inputs = inputs;
    t.nodes = references_.nodes();
    t.weights = references_.weights();
    t.feature_gradients = feature_gradients_.data();
    t.bucket_counts = references_.counts(chunk);
    t.bucket_shift = buckets_.shift;
    t.accepted = triangle_steps_.empty() ? nullptr : accepted_.data();
    t.gradients = gradients;
    t.statistics = &chunk_statistics_[chunk];
    table_.train(t);
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

  // Gradients are summed in the order of the chunks.
  packed_gradient_.assign(gradient_size, 0.0f);
  for (std::uint32_t chunk = 0; chunk < chunks.count(); ++chunk) {
    const float* g = chunk_gradients_.data() + chunk * gradient_size;
    for (std::uint64_t i = 0; i < gradient_size; ++i) packed_gradient_[i] += g[i];
  }
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

void CpuBackend::update_features(double scale, const TrainingBatch& batch, StepStatistics& statistics) {
  std::vector<std::uint32_t> record_steps;
  if (!triangle_steps_.empty()) record_steps = count_triangles(batch);
  if (buckets_.count == 0) return;
  const bool dense = options_.update == FeatureUpdate::dense;
  const bool per_triangle = options_.feature_step == FeatureStep::per_triangle && !dense;
  const std::size_t bucket_nodes = std::size_t{1} << buckets_.shift;
  std::vector<std::uint64_t> touched(buckets_.count, 0), skipped(buckets_.count, 0);

  for_each(buckets_.count, [&](std::size_t number) {
    const auto bucket = static_cast<std::uint32_t>(number);
    if (references_.size(bucket) == 0 && !dense) return;
    const FlushDenormals flush;
    BucketScratch& mine = bucket_scratch_.local();
    if (mine.sums.empty())
      mine = {HugeBuffer<float>(bucket_nodes * layout_.features),
              HugeBuffer<std::uint64_t>(bucket_nodes / 64 + 1), HugeBuffer<std::uint32_t>(bucket_nodes),
              HugeBuffer<std::uint32_t>(bucket_nodes)};
    KernelFeatureUpdate u = {};
    u.references = references_.begin(bucket);
    u.reference_count = references_.size(bucket);
    u.first_node = buckets_.first(bucket);
    u.node_count = buckets_.size(bucket);
    u.features = layout_.features;
    u.feature_inputs = layout_.feature_inputs;
    u.feature_gradients = feature_gradients_.data();
    u.record_steps = per_triangle ? record_steps.data() : nullptr;
    u.dense = dense ? 1 : 0;
    u.adam = {options_.adam.beta1, options_.adam.beta2, static_cast<float>(scale)};
    u.steps = adam_table_.data();
    u.step_count = kAdamTableSteps;
    u.late_step = [](const void* context, std::uint64_t t) {
      return adam_step(*static_cast<const TrainingOptions*>(context), t);
    };
    u.late_context = &options_;
    u.dense_step = adam_step(options_, steps_);
    features_.set_update_view(u);
    u.sums = mine.sums.data();
    u.touched = mine.touched.data();
    u.touched_list = mine.touched_list.data();
    u.step_scratch = mine.steps.data();
    u.touched_count = &touched[bucket];
    u.skipped_count = &skipped[bucket];
    table_.update_features(u);
  });
  for (std::uint32_t b = 0; b < buckets_.count; ++b) {
    statistics.touched_nodes += touched[b];
    statistics.skipped_updates += skipped[b];
  }
}

StepStatistics CpuBackend::train(const TrainingBatch& batch) {
  check_batch(*model_, batch);
  const FlushDenormals flush;
  // References and offsets of gradients have 32 bits.
  const std::uint64_t most =
      std::numeric_limits<std::uint32_t>::max() / std::max(4 * layout_.inputs, model_->nodes_per_point());
  if (batch.points.size > most)
    throw BadConfiguration(fmt::format("batch: {} records, expected at most {}", batch.points.size, most));
  const Clock::time_point start = Clock::now();
  if (steps_ == 0 && layout_.biases && options_.start_at_mean) start_output_at_mean(batch);

  StepStatistics statistics = run_network(kernel_points(*model_, batch.points), batch.targets.data(), nullptr,
                                          static_cast<std::uint32_t>(batch.points.size), true);
  statistics.seconds_network = seconds_since(start);
  if (statistics.records > 0) {
    ++steps_;
    const double scale = 1.0 / (static_cast<double>(statistics.records) * model_->config.mlp.outputs);
    Clock::time_point phase = Clock::now();
    references_.sort(encoder_.nodes_per_level, layout_.features, layout_.feature_inputs);
    statistics.seconds_sort = seconds_since(phase);
    phase = Clock::now();
    statistics.skipped_updates += network_.update(packed_gradient_.data(), static_cast<float>(scale), steps_);
    update_features(scale, batch, statistics);
    statistics.seconds_update = seconds_since(phase);
  }
  statistics.seconds = seconds_since(start);
  return statistics;
}

NetworkPass CpuBackend::network_pass(std::span<const float> inputs, std::span<const float> targets) {
  const std::size_t records = targets.size() / model_->config.mlp.outputs;
  if (inputs.size() != records * network_.packed().kernel().input_stride)
    throw BadConfiguration(fmt::format("inputs: {} floats, expected {} rows of {}", inputs.size(), records,
                                       network_.packed().kernel().input_stride));
  const Clock::time_point start = Clock::now();
  const StepStatistics statistics =
      run_network({}, targets.data(), inputs.data(), static_cast<std::uint32_t>(records), false);
  return {statistics.loss, seconds_since(start)};
}

void CpuBackend::query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
  check_batch(*model_, batch, out);
  KernelEncoder encoder = encoder_;
  features_.set_query_view(encoder, options.averaged);
  const KernelNetwork& network = network_.query_kernel(options.averaged);
  const KernelPoints points = kernel_points(*model_, batch);
  const std::uint64_t scratch_floats = table_.scratch_floats(encoder, network);
  constexpr std::size_t kChunk = 64 * kTile;
  for_each((batch.size + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const FlushDenormals flush;
    KernelQuery q = {};
    q.encoder = &encoder;
    q.network = &network;
    q.points = points;
    q.begin = chunk * kChunk;
    q.end = std::min(batch.size, (chunk + 1) * kChunk);
    q.bf16 = options.precision == QueryPrecision::bf16 ? 1 : 0;
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
  network_.set(std::move(network));
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
  constexpr std::size_t kMostLevels = (std::size_t{1} << 31) / (sizeof(GateSurfaceLevel) / 4);
  if (model->gate.levels.size() >= kMostLevels)
    throw BadConfiguration(fmt::format("levels of all surfaces: {}, expected less than {}",
                                       model->gate.levels.size(), kMostLevels));
  return std::make_unique<CpuBackend>(std::move(model), options, simd::select_isa(isa));
}

NetworkPass network_pass(Backend& cpu_backend, std::span<const float> inputs,
                         std::span<const float> targets) {
  const FlushDenormals flush;
  return dynamic_cast<CpuBackend&>(cpu_backend).network_pass(inputs, targets);
}

}  // namespace gatelight::neural::cpu
