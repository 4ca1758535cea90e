#pragma once
// The version and the instruction set of the ray tracer, for reports. Embree's types are used only in
// renderer/surface/accel.cpp, by embree_api.h.

#include <string>

namespace gatelight::renderer {

/// The widest instruction set of this machine: avx512, avx2 or scalar.
std::string best_isa();

/// The version of the headers that this library was compiled with.
std::string embree_version();

}  // namespace gatelight::renderer
