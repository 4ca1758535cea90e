#pragma once
// Typed, checked reading of accessors: strided, interleaved, normalised, sparse, or without data (zeros).

#include <cstdint>
#include <span>
#include <string>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// Indices of the elements to read; empty means all, in order.
using Selection = std::span<const std::uint32_t>;

/// One accessor. The constructor checks its layout against its buffer views, so reads stay inside them.
class AccessorReader {
 public:
  AccessorReader(const Document& document, int accessor);

  std::size_t count() const { return accessor_.count; }
  int components() const { return components_; }
  int component_type() const { return accessor_.componentType; }
  const std::string& where() const { return where_; }

  /// Throws SceneError for another number of components, for matrices, and for unsigned 32-bit integers,
  /// which only indices may have.
  void expect_attribute(std::string_view semantic, std::initializer_list<int> components) const;

  /// Writes selection.size() (or count()) rows of `width` floats. Integers are mapped to [0, 1] or [-1, 1] if
  /// the accessor is `normalized` or `force_normalized` is set. Components that the accessor does not have
  /// are left unchanged.
  void read_floats(Selection selection, int width, float* out, bool force_normalized = false) const;

  /// Writes count() indices. Throws SceneError unless the accessor holds scalar unsigned integers.
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

/// Checks every accessor of the file, used or not. Throws SceneError.
void check_accessors(const Document& document);

}  // namespace gatelight::scene::gltf
