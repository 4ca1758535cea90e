#pragma once
// The CPU member of the backends: fused SIMD kernels on oneTBB threads.

#include <memory>
#include <optional>

#include "neural/backend.h"
#include "neural/cpu/isa.h"

namespace gatelight::neural::cpu {

/// Uses the task arena of the calling thread. Throws Unavailable for an ISA that is not there.
std::unique_ptr<Backend> make_cpu_backend(std::shared_ptr<const Model> model, const TrainingOptions& options,
                                          std::optional<Isa> isa = std::nullopt);

}  // namespace gatelight::neural::cpu
