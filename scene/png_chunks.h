#pragma once
// Checks and filters a PNG file's chunks before a decoder sees them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gatelight::scene {

/// Keeps the chunks that define the pixels (IHDR, PLTE, tRNS, IDAT, IEND) and drops the rest: glTF ignores
/// colour profiles and gamma. Checksums are verified here because libpng prints its complaints to stderr; a
/// common colour profile is enough to trigger one. For a damaged file the result is empty and `problem` gives
/// the reason.
std::vector<std::uint8_t> essential_png(std::span<const std::uint8_t> file, std::string& problem);

}  // namespace gatelight::scene
