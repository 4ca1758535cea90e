#pragma once
// The tables of the objects that are compiled for each instruction set.

#include "renderer/shading/kernels.h"

namespace gatelight::renderer {

extern const ShadingKernels kScalarShading;
extern const ShadingKernels kAvx2Shading;
extern const ShadingKernels kAvx512Shading;

}  // namespace gatelight::renderer
