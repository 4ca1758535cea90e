#include "neural/vulkan/step_queue.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "neural/vulkan/point_upload.h"
#include "neural/vulkan/step_commands.h"

namespace gatelight::neural::vulkan {

namespace {

/// Groups in progress: one computes, one waits, one is being filled.
constexpr std::size_t kGroups = 3;
/// Steps of a group, and bytes of their batches unless one step has more: 65536 records take 5 MiB.
constexpr std::size_t kGroupSteps = 64;
constexpr std::uint64_t kGroupBytes = std::uint64_t{8} << 20;
constexpr std::uint64_t kStatisticsBytes = 4 * glsl::kStatisticsWords;

StepStatistics read_statistics(const std::byte* from, std::uint32_t outputs) {
  std::uint32_t words[glsl::kStatisticsWords];
  std::memcpy(words, from, sizeof(words));
  StepStatistics statistics;
  statistics.records = words[glsl::kAccepted];
  statistics.rejected = words[glsl::kRejected];
  statistics.unstored = words[glsl::kUnstored];
  statistics.clipped = words[glsl::kClipped];
  statistics.skipped_updates = words[glsl::kSkipped];
  statistics.touched_nodes = words[glsl::kTouched];
  if (statistics.records > 0)
    statistics.loss = static_cast<double>(std::bit_cast<float>(words[glsl::kLoss])) /
                      (static_cast<double>(statistics.records) * outputs);
  return statistics;
}

}  // namespace

StepQueue::Group::Group(const Device& device) : Submission(device, 1 + kStepStamps * kGroupSteps) {
  result = Buffer(device, kGroupSteps * kStatisticsBytes, BufferUse::device);
  readback = Buffer(device, kGroupSteps * kStatisticsBytes, BufferUse::readback);
}

StepQueue::StepQueue(Machine& machine, const Model& model, const TrainingOptions& options,
                     const FeatureStore& features, const NetworkStore& network)
    : machine_(machine),
      model_(model),
      options_(options),
      features_(features),
      network_(network),
      tile_(training_tile(model, machine.device().limits().shared_bytes)) {
  for (std::size_t i = 0; i < kGroups; ++i) groups_.emplace_back(machine.device());
}

void StepQueue::start(std::span<const TrainingBatch> batches, Address model_block) {
  while (!batches.empty()) {
    std::size_t steps = 0;
    std::uint64_t bytes = 0;
    while (steps < std::min(batches.size(), kGroupSteps)) {
      const std::uint64_t more = upload_bytes(model_, batches[steps].points.size, true);
      if (steps > 0 && bytes + more > kGroupBytes) break;
      bytes += more;
      ++steps;
    }
    submit(batches.first(steps), bytes, model_block);
    batches = batches.subspan(steps);
  }
}

void StepQueue::submit(std::span<const TrainingBatch> batches, std::uint64_t bytes, Address model_block) {
  const Device& device = machine_.device();
  if (started_ - collected_ == kGroups) collect_oldest();
  const auto smaller = [](const TrainingBatch& a, const TrainingBatch& b) {
    return a.points.size < b.points.size;
  };
  const std::uint64_t most = std::ranges::max(batches, smaller).points.size;
  if (most > scratch_.capacity()) {
    while (started_ > collected_) collect_oldest();  // these steps use the arrays that are about to grow
    scratch_.reserve(device, model_, most, tile_);
  }
  Group& group = groups_[started_ % kGroups];
  reserve(device, group.staging, bytes, BufferUse::upload);
  reserve(device, group.batch, bytes, BufferUse::device);

  Commands commands(group.commands.front(), machine_, model_block, group.batch.address());
  commands.reset(group.stamps, static_cast<std::uint32_t>(1 + kStepStamps * batches.size()));
  commands.copy(group.staging, group.batch, bytes);
  commands.fill(group.result, 0);
  commands.barrier();
  commands.stamp(group.stamps, 0);
  std::uint64_t at = 0;
  for (std::uint32_t i = 0; i < batches.size(); ++i) {
    const QueryBatch& points = batches[i].points;
    const StepCut cut = cut_step(model_, points.size, tile_);
    BatchBlock block = block_of(cut, group, i);
    const Address address = group.batch.address() + at;
    write_upload(model_, points, batches[i].targets, 0, address, block, group.staging.mapped() + at);
    commands.read_batch(address);
    record_step({model_, options_, features_, cut, tile_, may_be_first_}, group.stamps, kStepStamps * i,
                commands);
    at += upload_bytes(model_, points.size, true);
  }
  commands.copy(group.result, group.readback, kStatisticsBytes * batches.size());
  commands.submit(group.fence);
  group.steps = batches.size();
  ++started_;
}

BatchBlock StepQueue::block_of(const StepCut& cut, const Group& group, std::size_t step) const {
  BatchBlock block = scratch_.block();
  block.read = features_.readable(false);
  block.statistics = group.result.address() + kStatisticsBytes * step;
  block.forward = network_.forward();
  block.size = cut.size;
  block.references = cut.references;
  block.tiles = cut.tiles;
  block.groups = cut.groups;
  return block;
}

StepStatistics StepQueue::finish() {
  if (finished_.empty()) collect_oldest();
  const StepStatistics statistics = finished_.front();
  finished_.pop_front();
  return statistics;
}

void StepQueue::collect_oldest() {
  Group& group = groups_[collected_ % kGroups];
  ++collected_;
  const std::size_t first = finished_.size();
  finished_.resize(first + group.steps);  // they stay empty if the wait throws
  wait_for(machine_.device(), group.fence);
  machine_.check();
  const std::vector<double> seconds =
      stamped_seconds(machine_.device(), group, 1 + kStepStamps * group.steps);
  for (std::size_t i = 0; i < group.steps; ++i) {
    StepStatistics& step = finished_[first + i];
    step = read_statistics(group.readback.mapped() + kStatisticsBytes * i, model_.config.mlp.outputs);
    if (step.records > 0) may_be_first_ = false;
    const double* const stamps = &seconds[kStepStamps * i];
    step.seconds_network = stamps[1] - stamps[0];
    step.seconds_sort = stamps[2] - stamps[1];
    step.seconds_update = stamps[3] - stamps[2];
    step.seconds = stamps[3] - stamps[0];
  }
}

}  // namespace gatelight::neural::vulkan
