#include "scene/gltf/draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>

namespace gatelight::scene::gltf {

namespace {

/// The type of glTF, or 0 for one that glTF does not have.
int component_type(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return kByte;
    case draco::DT_UINT8:
      return kUnsignedByte;
    case draco::DT_INT16:
      return kShort;
    case draco::DT_UINT16:
      return kUnsignedShort;
    case draco::DT_FLOAT32:
      return kFloat;
    default:
      return 0;
  }
}

bool read_rows(const draco::PointAttribute& attribute, Selection selection, std::size_t rows, int width,
               bool normalized, float* out) {
  const int type = component_type(attribute.data_type());
  if (type == 0) return false;
  const int n = std::min<int>(attribute.num_components(), width);
  const std::size_t size = static_cast<std::size_t>(n) * component_size(type);
  for (std::size_t i = 0; i < rows; ++i, out += width) {
    const std::uint32_t point = selection.empty() ? static_cast<std::uint32_t>(i) : selection[i];
    const draco::AttributeValueIndex entry = attribute.mapped_index(draco::PointIndex(point));
    if (entry.value() >= attribute.size()) return false;
    const std::uint8_t* bytes = attribute.GetAddress(entry);
    if (!attribute.IsAddressValid(bytes) || !attribute.IsAddressValid(bytes + size - 1)) return false;
    to_floats(type, bytes, n, normalized, out);
  }
  return true;
}

}  // namespace

DracoPrimitive::DracoPrimitive(const Document& document, const tinygltf::Value& extension, std::string where)
    : document_(document),
      extension_(extension),
      where_(std::move(where) + ".extensions.KHR_draco_mesh_compression") {
  const Bytes bytes = document.view(integer_or(extension, "bufferView", -1), where_);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string error = "no mesh";
  try {
    auto result = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (result.ok()) {
      mesh_ = std::move(result).value();
    } else {
      error = result.status().error_msg_string();
    }
  } catch (const std::exception& e) {
    // Wrong counts in damaged data lead to failed allocations.
    error = e.what();
  }
  if (!mesh_) document.fail(where_, fmt::format("cannot be decoded ({}), expected a Draco mesh", error));
}

DracoPrimitive::~DracoPrimitive() = default;

std::size_t DracoPrimitive::vertex_count() const {
  return mesh_->num_points();
}

int DracoPrimitive::id_of(const std::string& semantic) const {
  const tinygltf::Value* attributes = find_member(extension_, "attributes");
  return attributes ? integer_or(*attributes, semantic.c_str(), -1) : -1;
}

bool DracoPrimitive::has(const std::string& semantic) const {
  return id_of(semantic) >= 0;
}

void DracoPrimitive::read_floats(const std::string& semantic, Selection selection, int width, bool normalized,
                                 float* out) const {
  const int id = id_of(semantic);
  const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!attribute)
    document_.fail(where_, fmt::format("{} is attribute {}, expected one of the data", semantic, id));
  const std::size_t rows = selection.empty() ? vertex_count() : selection.size();
  if (!read_rows(*attribute, selection, rows, width, normalized, out)) {
    document_.fail(where_,
                   fmt::format("{} cannot be read, expected values of 8 or 16 bits or float", semantic));
  }
}

void DracoPrimitive::read_triangles(std::vector<std::array<std::uint32_t, 3>>& out) const {
  out.resize(mesh_->num_faces());
  for (std::uint32_t i = 0; i < out.size(); ++i) {
    const draco::Mesh::Face& face = mesh_->face(draco::FaceIndex(i));
    out[i] = {face[0].value(), face[1].value(), face[2].value()};
  }
}

}  // namespace gatelight::scene::gltf
