#pragma once
// A look at a PNG file's chunks before a decoder sees them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gatelight::scene {

/// Keeps the chunks that make the picture (IHDR, PLTE, tRNS, IDAT, IEND) and drops the rest; glTF asks to
/// ignore colour profiles and gamma. libpng prints to stderr what it dislikes, and a common profile is enough
/// for that; so checksums are compared here, too. Returns an empty list, and says why in `problem`, when the
/// file is damaged.
std::vector<std::uint8_t> essential_png(std::span<const std::uint8_t> file, std::string& problem);

}  // namespace gatelight::scene
