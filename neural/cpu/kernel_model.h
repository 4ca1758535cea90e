#pragma once
// Converts the model's structs to those of the kernels.

#include "base/simd/isa.h"
#include "neural/cpu/kernels.h"
#include "neural/model/batch.h"
#include "neural/model/model.h"

namespace gatelight::neural::cpu {

/// Sets all members except the feature pointers. The model must outlive the result.
KernelEncoder kernel_encoder(const Model& model);

/// Spans that the model does not read become null.
KernelPoints kernel_points(const Model& model, const QueryBatch& batch);

/// The functions of an instruction set; for AVX-512, those with BF16 instructions if the processor has them.
const KernelTable& kernel_table(simd::Isa isa);

}  // namespace gatelight::neural::cpu
