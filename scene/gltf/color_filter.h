#pragma once
// The filter COLOR of KHR_meshopt_compression, which libmeshoptimizer has since 1.0.

#include <cstddef>
#include <cstdint>
#include <span>

namespace gatelight::scene::gltf {

/// Replaces colours in YCoCg by R, G, B and A of 8 or 16 bits. `stride` is 4 or 8 bytes a colour.
void decode_color_filter(std::span<std::uint8_t> bytes, std::size_t stride);

}  // namespace gatelight::scene::gltf
