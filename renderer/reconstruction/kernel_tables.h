#pragma once
// The tables of the objects that are compiled for each instruction set.

#include "renderer/reconstruction/kernels.h"

namespace gatelight::renderer {

extern const ReconstructionKernels kScalarReconstruction;
extern const ReconstructionKernels kAvx2Reconstruction;
extern const ReconstructionKernels kAvx512Reconstruction;

}  // namespace gatelight::renderer
