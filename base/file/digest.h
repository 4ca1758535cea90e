#pragma once
// 128-bit digests of data by XXH3. They detect mistakes, not forgery.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gatelight {

struct Digest {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const Digest&, const Digest&) = default;
};

Digest digest_of(std::span<const std::byte> bytes);

/// 32 hexadecimal digits.
std::string hexadecimal(const Digest& digest);

/// Collects values for a digest. Texts are added with their length, so that different sequences differ.
class DigestRecord {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>,
                  "padding would be hashed");
    add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  void add(const Digest& digest) {
    add(digest.high);
    add(digest.low);
  }
  void add_text(const std::string& text) {
    add(std::uint64_t{text.size()});
    add_bytes(std::as_bytes(std::span(text)));
  }
  Digest digest() const { return digest_of(bytes_); }

 private:
  void add_bytes(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  std::vector<std::byte> bytes_;
};

}  // namespace gatelight
