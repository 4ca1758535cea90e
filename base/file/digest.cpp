#include "base/file/digest.h"

#include <fmt/format.h>

// Compiles xxHash into this source, the only one that uses it, so that no library is linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace gatelight {

Digest digest_of(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

std::string hexadecimal(const Digest& digest) {
  return fmt::format("{:016x}{:016x}", digest.high, digest.low);
}

}  // namespace gatelight
