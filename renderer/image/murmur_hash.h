#pragma once

#include <cstdint>
#include <string_view>

namespace gatelight::renderer {

/// MurmurHash3_x86_32 of the text's bytes with the seed 0 (A. Appleby, in the public domain).
std::uint32_t murmur_hash(std::string_view text);

}  // namespace gatelight::renderer
