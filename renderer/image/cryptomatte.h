#pragma once
// The layers of Cryptomatte, from which compositing cuts out objects by their names: ids of names, how much
// of a pixel each covers, and the names in the header. After the public specification 1.2 of Psyop
// (github.com/Psyop/Cryptomatte).

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Prefix of all entries of the header.
inline constexpr std::string_view kCryptomattePrefix = "cryptomatte/";

/// The bits of the float that stands for a name: its hash, with the exponent's last bit flipped where the
/// float would be a denormal number, infinite or NaN. Never 0, which means nothing.
std::uint32_t cryptomatte_id(std::string_view name);

/// The share of a pixel that one id covers.
struct IdCoverage {
  std::uint32_t id = 0;
  float coverage = 0.0f;
};

/// Number of ids that a pixel keeps.
inline constexpr std::size_t kCryptomatteRanks = 6;
/// Number of layers. Each has two ids: id, coverage, id, coverage.
inline constexpr std::size_t kCryptomatteLayers = kCryptomatteRanks / 2;

/// Layers of one or several kinds of names, and their entries of the header.
struct Cryptomattes {
  std::vector<Layer> layers;
  std::map<std::string, std::string> attributes;  ///< Picture::attributes
};

/// Adds the empty layers of a kind of names, as "CryptoObject", and its entries: all names with their ids,
/// visible or not. Returns the number of its first layer.
std::size_t add_kind(Cryptomattes& mattes, const std::string& kind, std::span<const std::string> names,
                     std::size_t pixels);

/// Sets a pixel of a kind whose layers begin at `first`. Ids are expected in the order of their ranks; those
/// beyond the last rank are left out.
void set_pixel(Cryptomattes& mattes, std::size_t first, std::size_t pixel, std::span<const IdCoverage> ids);

/// Appends the layers to a picture, with their entries.
void add_cryptomattes(Picture& picture, Cryptomattes mattes);

/// Whether a layer of a file holds ids and coverages, which have no mean.
bool is_cryptomatte(const Picture& picture, const std::string& layer);

}  // namespace gatelight::renderer
