#pragma once
// The CPU member of the backends: fused SIMD kernels on oneTBB threads.

#include <memory>
#include <optional>

#include "neural/cpu/isa.h"
#include "neural/model/backend.h"

namespace gatelight::neural::cpu {

/// Uses the task arena of the calling thread. Throws Unavailable for an ISA that is not there.
std::unique_ptr<Backend> make_cpu_backend(std::shared_ptr<const Model> model, const TrainingOptions& options,
                                          std::optional<Isa> isa = std::nullopt);

/// The network's arithmetic alone: forward, loss, backward and weight gradients over rows of encoded inputs,
/// without lookups and without an update. For measuring what encoding and optimiser add.
struct NetworkPass {
  double loss = 0.0;
  double seconds = 0.0;
};
/// `inputs`: rows of the smallest power of two from 16 on that holds the model's inputs. `backend` is one of
/// make_cpu_backend's.
NetworkPass network_pass(Backend& backend, std::span<const float> inputs, std::span<const float> targets);

}  // namespace gatelight::neural::cpu
