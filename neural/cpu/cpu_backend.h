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

}  // namespace gatelight::neural::cpu
