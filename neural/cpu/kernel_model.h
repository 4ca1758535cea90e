#pragma once
// From the model's structs to the kernels'.

#include "neural/base/batch.h"
#include "neural/cpu/isa.h"
#include "neural/cpu/kernels.h"
#include "neural/model/model.h"

namespace gatelight::neural::cpu {

/// All but the feature pointers. The model must outlive it.
KernelEncoder kernel_encoder(const Model& model);

/// Spans that the model does not read are left out.
KernelPoints kernel_points(const Model& model, const QueryBatch& batch);

/// The table of an instruction set; for AVX-512 the one with BF16 instructions where the processor has them.
const KernelTable& kernel_table(Isa isa);

}  // namespace gatelight::neural::cpu
