#pragma once
// Typed, checked reading of accessors: strided, interleaved, normalised, sparse, or without any data (zeros).

#include <cstdint>
#include <span>
#include <string>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// Which elements to read; empty means all of them, in order.
using Selection = std::span<const std::uint32_t>;

/// One accessor. Making one checks its layout against its buffer views; reading cannot leave them.
class AccessorReader {
 public:
  AccessorReader(const Document& document, int accessor);

  std::size_t count() const { return accessor_.count; }
  int components() const { return components_; }
  int component_type() const { return accessor_.componentType; }
  const std::string& where() const { return where_; }

  /// Refuses an accessor of another type or component type. Unsigned 32-bit integers are for indices alone.
  void expect_attribute(std::string_view semantic, std::initializer_list<int> components) const;

  /// Writes selection.size() (or count()) rows of `width` floats. Integers are mapped by the accessor's
  /// `normalized`, or always to [0, 1] or [-1, 1] if `force_normalized`. Components beyond the accessor's own
  /// are left as they are.
  void read_floats(Selection selection, int width, float* out, bool force_normalized = false) const;

  /// Writes count() indices. Refuses other types than scalars of unsigned integers.
  void read_indices(std::uint32_t* out) const;

 private:
  void check_range(int view, std::size_t offset, std::size_t count, std::size_t stride, std::size_t element,
                   std::string_view where) const;
  void apply_sparse(float* rows, bool normalized) const;

  const Document& document_;
  const tinygltf::Accessor& accessor_;
  std::string where_;
  int components_ = 0;
  std::size_t element_size_ = 0;
  std::size_t stride_ = 0;
};

/// Every accessor of the file, used or not.
void check_accessors(const Document& document);

}  // namespace gatelight::scene::gltf
