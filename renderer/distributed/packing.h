#pragma once
// Packs values into bytes for the other ranks of a picture.

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gatelight::renderer {

using Bytes = std::vector<std::byte>;

/// Appends values. They are numbers, or structs of numbers without pointers (Eigen's vectors of fixed size
/// are such).
class Packer {
 public:
  template <class T>
  void add(const T& value) {
    add_all(std::span(&value, 1));
  }
  template <class T>
  void add_all(std::span<T> values) {
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads the values in the same order. Throws std::length_error where there are fewer.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : rest_(bytes) {}
  template <class T>
  void read_all(std::span<T> values) {
    if (values.size_bytes() > rest_.size())
      throw std::length_error("another rank sent less than this one expects: their programs differ");
    if (values.empty()) return;
    std::memcpy(static_cast<void*>(values.data()), rest_.data(), values.size_bytes());
    rest_ = rest_.subspan(values.size_bytes());
  }
  template <class T>
  T read() {
    T value{};
    read_all(std::span(&value, 1));
    return value;
  }
  /// All remaining values.
  template <class T>
  std::vector<T> rest() {
    std::vector<T> values(rest_.size() / sizeof(T));
    read_all(std::span(values));
    return values;
  }
  bool done() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

template <class Values>
Bytes packed(const Values& values) {
  Packer packer;
  packer.add_all(std::span(values));
  return packer.take();
}

/// The values of all these bytes, one after the other.
template <class T>
std::vector<T> unpacked(const std::vector<Bytes>& all) {
  std::vector<T> values;
  for (const Bytes& bytes : all) {
    const std::vector<T> of_one = Unpacker(bytes).rest<T>();
    values.insert(values.end(), of_one.begin(), of_one.end());
  }
  return values;
}

}  // namespace gatelight::renderer
