#include "neural/vulkan/vulkan_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <optional>

#include "base/errors.h"
#include "neural/model/checks.h"
#include "neural/vulkan/errors.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/model_tables.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/point_upload.h"
#include "neural/vulkan/step_commands.h"
#include "neural/vulkan/step_queue.h"

namespace gatelight::neural::vulkan {

namespace {

/// Chunks of a query in progress, and points of a chunk.
constexpr std::size_t kChunks = 2;
constexpr std::size_t kChunkPoints = std::size_t{1} << 18;

/// The kind of packed weights in query_forward.
struct PackedFor {
  bool averaged = false, rounded = false;
  friend bool operator==(const PackedFor&, const PackedFor&) = default;
};

class VulkanBackend final : public Backend {
 public:
  VulkanBackend(std::shared_ptr<Machine> machine, std::shared_ptr<const Model> model,
                const TrainingOptions& options);
  ~VulkanBackend() override;

  StepStatistics train(const TrainingBatch& batch) override;
  void start(std::span<const TrainingBatch> batches, Team*) override;
  StepStatistics finish() override;
  bool runs_alongside() const override { return true; }
  void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const override;
  ModelState export_state() const override;
  void import_state(const ModelState& state) override;
  std::string name() const override { return fmt::format("vulkan {}", machine_->device().name()); }
  std::uint64_t parameter_bytes() const override {
    return features_.parameter_bytes() + network_.parameter_bytes();
  }
  std::uint64_t optimizer_bytes() const override {
    return features_.optimizer_bytes() + network_.optimizer_bytes();
  }

 private:
  template <class F>
  auto translate_errors(const char* operation, F&& body) const {
    return translated(machine_->device().name(), operation, std::forward<F>(body));
  }
  void describe_model();
  void submit_query(Submission& chunk, const QueryBatch& batch, const QueryOptions& options,
                    std::size_t begin) const;
  void read_results(Submission& chunk, std::size_t begin, std::span<float> out) const;
  void abandon_chunks() const;
  Address packed_for_query(const QueryOptions& options, std::optional<PackedFor>& to_pack) const;

  std::shared_ptr<Machine> machine_;
  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  mutable Transfer transfer_;
  ModelTables tables_;
  FeatureStore features_;
  NetworkStore network_;
  Buffer model_block_, pack_block_;
  std::uint32_t query_tile_;
  StepQueue steps_;

  mutable std::vector<Submission> chunks_;
  mutable Buffer query_inputs_, query_status_;
  mutable std::optional<PackedFor> packed_;
};

VulkanBackend::VulkanBackend(std::shared_ptr<Machine> machine, std::shared_ptr<const Model> model,
                             const TrainingOptions& options)
    : machine_(std::move(machine)),
      model_(std::move(model)),
      options_(options),
      transfer_(machine_->device()),
      tables_(machine_->device(), transfer_, *model_, options_, machine_->longest_part()),
      features_(machine_->device(), transfer_, *model_, options_, machine_->longest_part()),
      network_(machine_->device(), transfer_, *model_, options_),
      query_tile_(query_tile(*model_, machine_->device().limits().shared_bytes)),
      steps_(*machine_, *model_, options_, features_, network_) {
  for (std::size_t i = 0; i < kChunks; ++i) chunks_.emplace_back(machine_->device());
  describe_model();
  import_state(initial_state(*model_, options_));
}

VulkanBackend::~VulkanBackend() {
  try {
    machine_->device().handle().waitIdle();
  } catch (const vk::SystemError&) {
    // A lost device has no work in progress.
  }
}

void VulkanBackend::describe_model() {
  ModelBlock block;
  tables_.describe(block);
  features_.describe(block);
  network_.describe(block);
  model_block_ = Buffer(machine_->device(), sizeof(block), BufferUse::device);
  transfer_.write(model_block_, std::as_bytes(std::span(&block, 1)));
  BatchBlock pack;
  pack.forward = network_.forward();
  pack_block_ = Buffer(machine_->device(), sizeof(pack), BufferUse::device);
  transfer_.write(pack_block_, std::as_bytes(std::span(&pack, 1)));
}

StepStatistics VulkanBackend::train(const TrainingBatch& batch) {
  start({&batch, 1}, nullptr);
  return finish();
}

void VulkanBackend::start(std::span<const TrainingBatch> batches, Team*) {
  const std::uint64_t most = most_records(*model_, machine_->device().limits().longest_buffer);
  for (const TrainingBatch& batch : batches) {
    check_batch(*model_, batch);
    if (batch.points.size > most)
      throw BadConfiguration(
          {"batch", fmt::format("{}", batch.points.size), "", fmt::format("at most {}", most)});
  }
  packed_.reset();
  translate_errors("training", [&] { steps_.start(batches, model_block_.address()); });
}

StepStatistics VulkanBackend::finish() {
  if (!steps_.any()) throw BadConfiguration("finish: no step was started");
  return translate_errors("training", [&] { return steps_.finish(); });
}

void VulkanBackend::query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
  check_batch(*model_, batch, out);
  translate_errors("answering", [&] {
    abandon_chunks();
    const std::size_t chunks = (batch.size + kChunkPoints - 1) / kChunkPoints;
    for (std::size_t k = 0; k < chunks + kChunks; ++k) {
      Submission& chunk = chunks_[k % kChunks];
      if (chunk.under_way) read_results(chunk, (k - kChunks) * kChunkPoints, out);
      if (k < chunks) submit_query(chunk, batch, options, k * kChunkPoints);
    }
  });
}

// Waits for the chunks of a query that an exception ended.
void VulkanBackend::abandon_chunks() const {
  for (Submission& chunk : chunks_) {
    if (!chunk.under_way) continue;
    chunk.under_way = false;
    wait_for(machine_->device(), chunk.fence);
  }
}

Address VulkanBackend::packed_for_query(const QueryOptions& options,
                                        std::optional<PackedFor>& to_pack) const {
  const PackedFor wanted{options.averaged && network_.averages(), options.precision == QueryPrecision::bf16};
  if (wanted == PackedFor{}) return network_.forward();
  if (packed_ != wanted) to_pack = wanted;
  return network_.query_forward();
}

void VulkanBackend::submit_query(Submission& chunk, const QueryBatch& batch, const QueryOptions& options,
                                 std::size_t begin) const {
  const Device& device = machine_->device();
  const std::size_t size = std::min(kChunkPoints, batch.size - begin);
  const std::size_t outputs = model_->config.mlp.outputs;
  const std::uint64_t bytes = upload_bytes(*model_, size, false);
  reserve(device, chunk.staging, bytes, BufferUse::upload);
  reserve(device, chunk.batch, bytes, BufferUse::device);
  reserve(device, chunk.result, 4 * size * outputs, BufferUse::device);
  reserve(device, chunk.readback, 4 * size * outputs, BufferUse::readback);
  if (query_status_.bytes() < 4 * size) device.handle().waitIdle();  // the other chunk may use these buffers
  reserve(device, query_inputs_, 4 * size * model_->parameters.inputs, BufferUse::device);
  reserve(device, query_status_, 4 * size, BufferUse::device);

  std::optional<PackedFor> to_pack;
  BatchBlock block;
  block.read = features_.readable(options.averaged);
  block.inputs = query_inputs_.address();
  block.status = query_status_.address();
  block.answers = chunk.result.address();
  block.forward = packed_for_query(options, to_pack);
  block.size = block.capacity = static_cast<std::uint32_t>(size);
  block.tiles = static_cast<std::uint32_t>((size + query_tile_ - 1) / query_tile_);
  write_upload(*model_, batch, {}, begin, chunk.batch.address(), block, chunk.staging.mapped());

  Commands commands(chunk.commands.front(), *machine_, model_block_.address(), chunk.batch.address());
  commands.copy(chunk.staging, chunk.batch, bytes);
  commands.barrier();
  std::vector<std::uint32_t> constants = network_constants(*model_);
  if (to_pack)
    commands.dispatch(
        Shader::pack_network, {}, groups_for(model_->parameters.network_count()),
        (to_pack->averaged ? glsl::kPackAveraged : 0u) | (to_pack->rounded ? glsl::kPackRounded : 0u));
  commands.dispatch(Shader::encode,
                    std::array{static_cast<std::uint32_t>(model_->config.encoding),
                               features_.halves() ? 1u : 0u, 0u, std::max(model_->parameters.features, 1u)},
                    groups_for(size));
  commands.barrier();
  constants.insert(constants.end(),
                   {query_tile_, std::bit_cast<std::uint32_t>(model_->config.mlp.leaky_slope),
                    options.precision == QueryPrecision::bf16 ? 1u : 0u});
  commands.dispatch(Shader::forward, constants, block.tiles, static_cast<std::uint32_t>(options.range));
  commands.barrier();
  commands.copy(chunk.result, chunk.readback, 4 * size * outputs);
  commands.submit(chunk.fence);
  chunk.under_way = true;
  if (to_pack) packed_ = to_pack;
}

void VulkanBackend::read_results(Submission& chunk, std::size_t begin, std::span<float> out) const {
  chunk.under_way = false;
  wait_for(machine_->device(), chunk.fence);
  machine_->check();
  const std::size_t outputs = model_->config.mlp.outputs;
  const std::size_t floats = std::min(kChunkPoints * outputs, out.size() - begin * outputs);
  std::memcpy(out.data() + begin * outputs, chunk.readback.mapped(), 4 * floats);
}

ModelState VulkanBackend::export_state() const {
  return translate_errors("reading the state", [&] {
    ModelState state;
    for (std::vector<float>* array :
         {&state.parameters, &state.averages, &state.first_moments, &state.second_moments})
      array->resize(model_->parameters.count);
    features_.export_to(transfer_, state);
    network_.export_to(transfer_, state);
    machine_->check();
    return state;
  });
}

void VulkanBackend::import_state(const ModelState& state) {
  check_state(*model_, options_, state);
  check_state_numbers(state);
  translate_errors("writing the state", [&] {
    abandon_chunks();
    features_.import_from(transfer_, state);
    network_.import_from(transfer_, state);
    Submission& pack = chunks_.front();
    Commands commands(pack.commands.front(), *machine_, model_block_.address(), pack_block_.address());
    record_training_pack(*model_, commands);
    commands.submit(pack.fence);
    wait_for(machine_->device(), pack.fence);
    machine_->check();
  });
  packed_.reset();
  steps_.set_first(state.steps == 0);
}

// Checked before any allocation, because some drivers promise more memory than they have.
void check_memory(const Device& device, const Model& model, const TrainingOptions& options) {
  const std::uint64_t needed = feature_bytes(model, options) + model.gate.report.topology_bytes;
  if (needed > device.limits().device_bytes)
    throw OutOfDeviceMemory(fmt::format("{}: a cache of {} MiB with its optimiser, on a device of {} MiB",
                                        device.name(), needed >> 20, device.limits().device_bytes >> 20));
}

}  // namespace

std::unique_ptr<Backend> make_vulkan_backend(std::shared_ptr<Machine> machine,
                                             std::shared_ptr<const Model> model,
                                             const TrainingOptions& options) {
  check_options(*model, options);
  check_memory(machine->device(), *model, options);
  const std::string device = machine->device().name();
  return translated(device, "making the cache", [&] {
    return std::make_unique<VulkanBackend>(std::move(machine), std::move(model), options);
  });
}

}  // namespace gatelight::neural::vulkan
