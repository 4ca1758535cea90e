#include "neural/vulkan/vulkan_backend.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "neural/model/checks.h"
#include "neural/vulkan/answers.h"
#include "neural/vulkan/errors.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/model_tables.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/point_upload.h"
#include "neural/vulkan/step_commands.h"
#include "neural/vulkan/step_queue.h"

namespace gatelight::neural::vulkan {

namespace {

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

  std::shared_ptr<Machine> machine_;
  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  mutable Transfer transfer_;
  ModelTables tables_;
  FeatureStore features_;
  NetworkStore network_;
  Buffer model_block_, pack_block_;
  StepQueue steps_;
  mutable Answers answers_;
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
      steps_(*machine_, *model_, options_, features_, network_),
      answers_(*machine_, *model_, features_, network_) {
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
  answers_.parameters_changed();
  translate_errors("training", [&] { steps_.start(batches, model_block_.address()); });
}

StepStatistics VulkanBackend::finish() {
  if (!steps_.any()) throw BadConfiguration("finish: no step was started");
  return translate_errors("training", [&] { return steps_.finish(); });
}

void VulkanBackend::query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
  check_batch(*model_, batch, out);
  translate_errors("answering", [&] { answers_.run(model_block_.address(), batch, options, out); });
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
    answers_.abandon();
    features_.import_from(transfer_, state);
    network_.import_from(transfer_, state);
    Submission pack(machine_->device());
    Commands commands(pack.commands.front(), *machine_, model_block_.address(), pack_block_.address());
    record_training_pack(*model_, commands);
    commands.submit(pack.fence);
    wait_for(machine_->device(), pack.fence);
    machine_->check();
  });
  answers_.parameters_changed();
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
