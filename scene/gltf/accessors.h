#pragma once
// Typed, checked reading of accessors: strided, interleaved, normalised, sparse, or without data (zeros).

#include <cstdint>
#include <span>
#include <string>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// The component types that glTF numbers.
enum ComponentType {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

/// In bytes.
std::size_t component_size(int type);

/// Converts `count` components of one element. Integers are mapped to [0, 1] or [-1, 1] if `normalized`.
void to_floats(int type, const std::uint8_t* element, int count, bool normalized, float* out);

/// Indices of the elements to read; empty means all, in order.
using Selection = std::span<const std::uint32_t>;

/// One accessor. The constructor checks its layout against its buffer views, so reads stay inside them.
class AccessorReader {
 public:
  AccessorReader(const Document& document, int accessor);

  std::size_t count() const { return count_; }
  int components() const { return components_; }
  int component_type() const { return type_; }
  const std::string& where() const { return where_; }

  /// False for another number of components, for matrices, and for unsigned 32-bit integers, which only
  /// indices may have.
  bool fits_attribute(std::initializer_list<int> components) const;
  /// Throws InputError where that is false.
  void expect_attribute(std::string_view semantic, std::initializer_list<int> components) const;

  /// Writes selection.size() (or count()) rows of `width` floats. Integers are mapped to [0, 1] or [-1, 1] if
  /// the accessor is `normalized` or `force_normalized` is set. Components that the accessor does not have
  /// are left unchanged.
  void read_floats(Selection selection, int width, float* out, bool force_normalized = false) const;

  /// Writes count() indices. Throws InputError unless the accessor holds scalar unsigned integers.
  void read_indices(std::uint32_t* out) const;

 private:
  /// The place of the elements. A view of -1 means zeros.
  struct Place {
    int view = -1;
    std::size_t offset = 0;
  };

  void check_range(const Place& place, std::size_t count, std::size_t stride, std::size_t element,
                   std::string_view where) const;
  const std::uint8_t* data(const Place& place) const {
    return document_.view(place.view, where_).data() + place.offset;
  }
  /// Calls write(index, element) for each sparse element.
  template <typename Write>
  void for_each_sparse(const Write& write) const;

  const Document& document_;
  const tinygltf::Accessor& accessor_;
  std::string where_;
  int type_ = 0;
  int components_ = 0;
  std::size_t count_ = 0;
  std::size_t element_size_ = 0;
  std::size_t stride_ = 0;
  Place place_;
  std::size_t sparse_count_ = 0;
  int index_type_ = kUnsignedInt;
  Place sparse_indices_;
  Place sparse_values_;
};

}  // namespace gatelight::scene::gltf
