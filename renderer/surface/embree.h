#pragma once
// What traces the rays, for reports. No type of Embree leaves renderer/surface/accel.cpp.

#include <string>

namespace gatelight::renderer {

/// The widest instruction set of this machine: avx512, avx2 or scalar.
std::string best_isa();

/// Of the headers that this library was compiled with.
std::string embree_version();

}  // namespace gatelight::renderer
