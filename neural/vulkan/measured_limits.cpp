#include "neural/vulkan/measured_limits.h"

#include <algorithm>

#include "neural/vulkan/commands.h"
#include "neural/vulkan/errors.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/submission.h"
#include "neural/vulkan/transfer.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kGroups = 8192;
constexpr std::uint64_t kOperationsARound = 64;
constexpr double kLongEnough = 0.02;  // seconds, so that launch overhead is negligible
constexpr std::uint32_t kMaxRounds = 1u << 20;

class Bench {
 public:
  Bench(Machine& machine, std::uint64_t bytes)
      : machine_(machine),
        transfer_(machine.device()),
        submission_(machine.device()),
        vectors_(machine.device(), bytes, BufferUse::device),
        answers_(machine.device(), 4 * kGroups * kWorkgroupThreads, BufferUse::device),
        block_(machine.device(), sizeof(BatchBlock), BufferUse::device) {
    BatchBlock batch;
    batch.forward = vectors_.address();
    batch.answers = answers_.address();
    transfer_.write(block_, std::as_bytes(std::span(&batch, 1)));
    transfer_.fill(vectors_, 0);
  }

  /// The device's time.
  double seconds(Shader shader, std::uint32_t argument, std::uint32_t repetitions) {
    Commands commands(submission_.commands.front(), machine_, 0, block_.address());
    commands.reset(submission_.stamps, kStamps);
    commands.barrier();
    commands.stamp(submission_.stamps, 0);
    for (std::uint32_t i = 0; i < repetitions; ++i) {
      commands.dispatch(shader, {}, kGroups, argument);
      commands.barrier();
    }
    commands.stamp(submission_.stamps, 1);
    commands.submit(submission_.fence);
    wait_for(machine_.device(), submission_.fence);
    return seconds_between(machine_.device(), submission_, 0, 1);
  }

  /// The least of four measurements.
  double least_seconds(Shader shader, std::uint32_t argument, std::uint32_t repetitions) {
    double least = seconds(shader, argument, repetitions);
    for (int i = 0; i < 3; ++i) least = std::min(least, seconds(shader, argument, repetitions));
    return least;
  }

 private:
  Machine& machine_;
  Transfer transfer_;
  Submission submission_;
  Buffer vectors_, answers_, block_;
};

}  // namespace

MeasuredLimits measure_limits(Machine& machine, std::uint64_t bytes) {
  MeasuredLimits limits;
  if (machine.device().limits().nanoseconds_per_tick == 0.0) return limits;
  return translated(machine.device().name(), "measuring", [&] {
    Bench bench(machine, bytes);
    std::uint32_t rounds = 16;
    while (bench.seconds(Shader::limit_fma, rounds, 1) < kLongEnough && rounds < kMaxRounds) rounds *= 2;
    limits.operations_per_second = static_cast<double>(kGroups * kWorkgroupThreads * kOperationsARound) *
                                   rounds / bench.least_seconds(Shader::limit_fma, rounds, 1);

    const auto vectors = static_cast<std::uint32_t>(bytes / 16);
    std::uint32_t repetitions = 1;
    while (bench.seconds(Shader::limit_read, vectors, repetitions) < kLongEnough && repetitions < 4096)
      repetitions *= 2;
    limits.bytes_per_second = static_cast<double>(bytes) * repetitions /
                              bench.least_seconds(Shader::limit_read, vectors, repetitions);
    return limits;
  });
}

}  // namespace gatelight::neural::vulkan
