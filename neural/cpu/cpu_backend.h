#pragma once
// The CPU backend: fused SIMD kernels on oneTBB threads.

#include <memory>
#include <optional>

#include "base/simd/isa.h"
#include "neural/model/backend.h"

namespace gatelight::neural::cpu {

/// Makes a backend that uses the task arena of the calling thread. Throws Unavailable if the ISA is not
/// available.
std::unique_ptr<Backend> make_cpu_backend(std::shared_ptr<const Model> model, const TrainingOptions& options,
                                          std::optional<simd::Isa> isa = std::nullopt);

/// Result of network_pass.
struct NetworkPass {
  double loss = 0.0;
  double seconds = 0.0;
};
/// Runs only the network, for benchmarks: forward, loss, backward and weight gradients, without lookups and
/// update. A row of `inputs` has the model's inputs, padded to a power of two of at least 16. `backend` must
/// come from make_cpu_backend.
NetworkPass network_pass(Backend& backend, std::span<const float> inputs, std::span<const float> targets);

}  // namespace gatelight::neural::cpu
