#pragma once
// The vertices of a primitive as rows of floats.

#include <initializer_list>
#include <map>
#include <string>

#include "scene/gltf/accessors.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/tinygltf.h"

namespace gatelight::scene::gltf {

/// The source of a primitive's vertices: accessors, or Draco's data described by accessors.
class Vertices {
 public:
  /// All must outlive it. Normals, tangents, texture coordinates and colours of a wrong form count as
  /// missing, with a warning. Throws InputError.
  Vertices(const Document& document, const tinygltf::Primitive& primitive, const DracoPrimitive* draco,
           std::string where, Warnings& warnings);

  std::size_t count() const { return count_; }
  /// Number of rows that a selection has.
  std::size_t rows(Selection selection) const { return selection.empty() ? count_ : selection.size(); }
  const std::string& where() const { return where_; }

  bool has(const std::string& semantic) const {
    return attributes_.contains(semantic) || (draco_ && draco_->has(semantic));
  }

  /// Writes rows(selection) rows of `width` floats. Throws InputError.
  void read(const std::string& semantic, std::initializer_list<int> components, Selection selection,
            int width, float* out, bool force_normalized = false) const;
  /// The same from an accessor that is not among the primitive's attributes.
  void read(int accessor, const std::string& semantic, std::initializer_list<int> components,
            Selection selection, int width, float* out, bool force_normalized = false) const;

 private:
  void drop(const std::string& semantic, std::initializer_list<int> components, Warnings& warnings);

  const Document& document_;
  std::map<std::string, int> attributes_;
  const DracoPrimitive* draco_;
  std::string where_;
  std::size_t count_ = 0;
};

/// Leaves the rows empty where the file has none.
template <typename Rows>
void read_rows(const Vertices& vertices, const std::string& semantic, Selection selection, Rows& rows) {
  constexpr int kWidth = Rows::value_type::RowsAtCompileTime;
  if (!vertices.has(semantic)) return;
  rows.resize(vertices.rows(selection));
  vertices.read(semantic, {kWidth}, selection, kWidth, rows.data()->data());
}

}  // namespace gatelight::scene::gltf
