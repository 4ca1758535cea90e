#pragma once
// The smallest pictures of glTF files.

#include <cstdint>
#include <vector>

namespace gatelight::scene {

/// 2x2: red, half-transparent green (0, 200, 0, 128); transparent (10, 20, 30, 0), (1, 2, 3, 64).
inline constexpr const char* kRgbaUri =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAGklEQVR42mP4z8Dwn+EEQwMDl4gcAyMTsw"
    "MALzMDycBfC3YAAAAASUVORK5CYII=";

/// A grey pixel.
inline constexpr const char* kPixelUri =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU"
    "5ErkJggg==";

/// 2x1 grey: 7, 250.
inline const std::vector<std::uint8_t> kGrey = {
    0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n', 0,    0,    0,    13,   'I',  'H',  'D',  'R',  0,
    0,    0,    2,    0,    0,    0,    1,    8,    0,    0,    0,    0,    0xd1, 0x49, 0x20, 0x56, 0,
    0,    0,    11,   'I',  'D',  'A',  'T',  0x78, 0xda, 0x63, 0x60, 0xff, 0x05, 0,    0x01, 0x0b, 0x01,
    0x02, 0x54, 0xf9, 0x8c, 0xc4, 0,    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};

}  // namespace gatelight::scene
