#include "scene/gltf/draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "scene/gltf/extensions.h"

namespace gatelight::scene::gltf {

struct DracoPrimitive::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

namespace {

template <typename T>
bool read_rows(const draco::PointAttribute& attribute, Selection selection, std::size_t rows, int width,
               bool normalized, float* out) {
  const int n = std::min<int>(attribute.num_components(), width);
  const std::size_t size = static_cast<std::size_t>(n) * sizeof(T);
  for (std::size_t i = 0; i < rows; ++i, out += width) {
    const std::uint32_t point = selection.empty() ? static_cast<std::uint32_t>(i) : selection[i];
    const draco::AttributeValueIndex entry = attribute.mapped_index(draco::PointIndex(point));
    if (entry.value() >= attribute.size()) return false;
    const std::uint8_t* bytes = attribute.GetAddress(entry);
    if (!attribute.IsAddressValid(bytes) || !attribute.IsAddressValid(bytes + size - 1)) return false;
    for (int c = 0; c < n; ++c) {
      T value;
      std::memcpy(&value, bytes + static_cast<std::size_t>(c) * sizeof(T), sizeof(T));
      out[c] = static_cast<float>(value);
      if constexpr (!std::is_floating_point_v<T>) {
        if (normalized) out[c] = std::max(out[c] / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
      }
    }
  }
  return true;
}

bool read_rows(const draco::PointAttribute& attribute, Selection selection, std::size_t rows, int width,
               bool normalized, float* out) {
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return read_rows<std::int8_t>(attribute, selection, rows, width, normalized, out);
    case draco::DT_UINT8:
      return read_rows<std::uint8_t>(attribute, selection, rows, width, normalized, out);
    case draco::DT_INT16:
      return read_rows<std::int16_t>(attribute, selection, rows, width, normalized, out);
    case draco::DT_UINT16:
      return read_rows<std::uint16_t>(attribute, selection, rows, width, normalized, out);
    case draco::DT_FLOAT32:
      return read_rows<float>(attribute, selection, rows, width, normalized, out);
    default:
      return false;
  }
}

}  // namespace

DracoPrimitive::DracoPrimitive(const Document& document, const tinygltf::Value& extension, std::string where)
    : document_(document),
      extension_(extension),
      where_(std::move(where) + ".extensions.KHR_draco_mesh_compression"),
      decoded_(std::make_unique<Decoded>()) {
  const Bytes bytes = document.view(integer_or(extension, "bufferView", 0), where_);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string error = "no mesh";
  try {
    auto result = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (result.ok()) {
      decoded_->mesh = std::move(result).value();
    } else {
      error = result.status().error_msg_string();
    }
  } catch (const std::exception& e) {
    // Wrong counts in damaged data lead to failed allocations.
    error = e.what();
  }
  if (!decoded_->mesh)
    document.fail(where_, fmt::format("cannot be decoded ({}), expected a Draco mesh", error));
}

DracoPrimitive::~DracoPrimitive() = default;

std::size_t DracoPrimitive::vertex_count() const {
  return decoded_->mesh->num_points();
}

bool DracoPrimitive::has(const std::string& semantic) const {
  return extension_.Get("attributes").Has(semantic);
}

int DracoPrimitive::attribute_id(const std::string& semantic) const {
  return integer_or(extension_.Get("attributes"), semantic, -1);
}

void DracoPrimitive::read_floats(const std::string& semantic, Selection selection, int width, bool normalized,
                                 float* out) const {
  const int id = attribute_id(semantic);
  const draco::PointAttribute* attribute =
      decoded_->mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!attribute)
    document_.fail(where_, fmt::format("{} is attribute {}, expected one of the data", semantic, id));
  const std::size_t rows = selection.empty() ? vertex_count() : selection.size();
  if (!read_rows(*attribute, selection, rows, width, normalized, out)) {
    document_.fail(where_,
                   fmt::format("{} cannot be read, expected values of 8 or 16 bits or float", semantic));
  }
}

void DracoPrimitive::read_triangles(std::vector<std::array<std::uint32_t, 3>>& out) const {
  out.resize(decoded_->mesh->num_faces());
  for (std::uint32_t i = 0; i < out.size(); ++i) {
    const draco::Mesh::Face& face = decoded_->mesh->face(draco::FaceIndex(i));
    out[i] = {face[0].value(), face[1].value(), face[2].value()};
  }
}

}  // namespace gatelight::scene::gltf
