#pragma once
// KHR_draco_mesh_compression: libdraco decodes one primitive's triangles and attributes.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/gltf/accessors.h"

namespace draco {
class Mesh;
}

namespace gatelight::scene::gltf {

class DracoPrimitive {
 public:
  /// Decodes the primitive. Throws InputError.
  DracoPrimitive(const Document& document, const tinygltf::Value& extension, std::string where);
  ~DracoPrimitive();

  std::size_t vertex_count() const;
  bool has(const std::string& semantic) const;
  /// Writes rows of `width` floats, as AccessorReader::read_floats does. The caller passes `normalized` from
  /// the attribute's accessor, because the compressed data need not contain it.
  void read_floats(const std::string& semantic, Selection selection, int width, bool normalized,
                   float* out) const;
  void read_triangles(std::vector<std::array<std::uint32_t, 3>>& out) const;

 private:
  /// The number of an attribute in the compressed data, or -1.
  int id_of(const std::string& semantic) const;

  const Document& document_;
  const tinygltf::Value& extension_;
  std::string where_;
  std::unique_ptr<draco::Mesh> mesh_;
};

}  // namespace gatelight::scene::gltf
