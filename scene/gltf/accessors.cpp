#include "scene/gltf/accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace gatelight::scene::gltf {
namespace {

/// An accessor without data stands for zeros. This bound keeps one line of JSON from filling the memory.
constexpr std::size_t kMaxZeros = std::size_t{1} << 20;

std::size_t component_size(int type) {
  return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

/// Equations of the glTF specification, section 3.6.2.2; KHR_mesh_quantization uses the same.
template <typename T>
float to_float(const std::uint8_t* bytes, bool normalized) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    const float f = static_cast<float>(value);
    if (!normalized) return f;
    return std::max(f / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
  }
}

template <typename T>
void convert(const std::uint8_t* base, std::size_t stride, Selection selection, std::size_t count,
             int components, int width, bool normalized, float* out) {
  const int n = std::min(components, width);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* element = base + (selection.empty() ? i : selection[i]) * stride;
    for (int c = 0; c < n; ++c) {
      out[c] = to_float<T>(element + static_cast<std::size_t>(c) * sizeof(T), normalized);
    }
    out += width;
  }
}

void convert(int type, const std::uint8_t* base, std::size_t stride, Selection selection, std::size_t count,
             int components, int width, bool normalized, float* out) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert<std::int8_t>(base, stride, selection, count, components, width, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<std::uint8_t>(base, stride, selection, count, components, width, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert<std::int16_t>(base, stride, selection, count, components, width, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<std::uint16_t>(base, stride, selection, count, components, width, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert<std::uint32_t>(base, stride, selection, count, components, width, normalized, out);
    default:
      return convert<float>(base, stride, selection, count, components, width, normalized, out);
  }
}

template <typename T>
void copy_indices(const std::uint8_t* base, std::size_t stride, std::size_t count, std::uint32_t* out) {
  if (sizeof(T) == 4 && stride == 4) {
    std::memcpy(out, base, count * 4);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, base + i * stride, sizeof(T));
    out[i] = value;
  }
}

void copy_indices(int type, const std::uint8_t* base, std::size_t stride, std::size_t count,
                  std::uint32_t* out) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) copy_indices<std::uint8_t>(base, stride, count, out);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) copy_indices<std::uint16_t>(base, stride, count, out);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) copy_indices<std::uint32_t>(base, stride, count, out);
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

AccessorReader::AccessorReader(const Document& document, int accessor)
    : document_(document),
      accessor_(document.model().accessors[static_cast<std::size_t>(accessor)]),
      where_(fmt::format("accessors[{}]", accessor)),
      components_(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_.type))),
      element_size_(static_cast<std::size_t>(components_) * component_size(accessor_.componentType)),
      stride_(element_size_) {
  if (!document.is_view(accessor_.bufferView)) {
    if (accessor_.count > kMaxZeros) {
      document.fail(where_, fmt::format("count {} without a bufferView, expected at most {}", accessor_.count,
                                        kMaxZeros));
    }
  } else {
    if (document.view_stride(accessor_.bufferView) != 0) stride_ = document.view_stride(accessor_.bufferView);
    if (stride_ < element_size_) {
      document.fail(where_, fmt::format("byteStride {}, expected at least {}", stride_, element_size_));
    }
    check_range(accessor_.bufferView, accessor_.byteOffset, accessor_.count, stride_, element_size_, where_);
  }
  if (!accessor_.sparse.isSparse) return;
  const auto& sparse = accessor_.sparse;
  const std::size_t entries = static_cast<std::size_t>(sparse.count);
  if (entries > accessor_.count) {
    document.fail(where_ + ".sparse", fmt::format("count {}, expected at most {}", entries, accessor_.count));
  }
  const std::size_t index_size = component_size(sparse.indices.componentType);
  check_range(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), entries,
              index_size, index_size, where_ + ".sparse.indices");
  check_range(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), entries,
              element_size_, element_size_, where_ + ".sparse.values");
}

void AccessorReader::check_range(int view, std::size_t offset, std::size_t count, std::size_t stride,
                                 std::size_t element, std::string_view where) const {
  const std::size_t size = document_.view_size(view);
  const bool fits =
      offset <= size && element <= size - offset && (count - 1) <= (size - offset - element) / stride;
  if (!fits) {
    document_.fail(where,
                   fmt::format("{} elements of {} bytes at {}, stride {}, expected to fit the {} bytes of "
                               "bufferViews[{}]",
                               count, element, offset, stride, size, view));
  }
}

void AccessorReader::expect_attribute(std::string_view semantic,
                                      std::initializer_list<int> components) const {
  const bool fits = std::find(components.begin(), components.end(), components_) != components.end() &&
                    (accessor_.type <= TINYGLTF_TYPE_VEC4 || accessor_.type == TINYGLTF_TYPE_SCALAR) &&
                    accessor_.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (fits) return;
  std::string wanted;
  for (const int n : components) wanted += fmt::format("{}{}", wanted.empty() ? "" : " or ", n);
  document_.fail(where_, fmt::format("{} components of type {} for {}, expected {} (not of type 5125)",
                                     components_, accessor_.componentType, semantic, wanted));
}

void AccessorReader::read_floats(Selection selection, int width, float* out, bool force_normalized) const {
  const bool normalized = accessor_.normalized || force_normalized;
  const std::size_t rows = selection.empty() ? count() : selection.size();
  const bool has_view = document_.is_view(accessor_.bufferView);
  if (accessor_.sparse.isSparse) {
    // Sparse accessors are rare and small: the whole accessor is assembled, then the selection is read from
    // it.
    std::vector<float> all(count() * static_cast<std::size_t>(components_), 0.0f);
    if (has_view) {
      convert(accessor_.componentType,
              document_.view(accessor_.bufferView, where_).data() + accessor_.byteOffset, stride_, {},
              count(), components_, components_, normalized, all.data());
    }
    apply_sparse(all.data(), normalized);
    convert<float>(reinterpret_cast<const std::uint8_t*>(all.data()),
                   static_cast<std::size_t>(components_) * sizeof(float), selection, rows, components_, width,
                   false, out);
  } else if (has_view) {
    convert(accessor_.componentType,
            document_.view(accessor_.bufferView, where_).data() + accessor_.byteOffset, stride_, selection,
            rows, components_, width, normalized, out);
  } else {
    for (std::size_t i = 0; i < rows; ++i)
      std::fill_n(out + i * static_cast<std::size_t>(width), std::min(components_, width), 0.0f);
  }
}

void AccessorReader::apply_sparse(float* rows, bool normalized) const {
  const auto& sparse = accessor_.sparse;
  const std::size_t entries = static_cast<std::size_t>(sparse.count);
  std::vector<std::uint32_t> places(entries);
  const std::size_t index_size = component_size(sparse.indices.componentType);
  copy_indices(sparse.indices.componentType,
               document_.view(sparse.indices.bufferView, where_).data() + sparse.indices.byteOffset,
               index_size, entries, places.data());
  const std::uint8_t* values =
      document_.view(sparse.values.bufferView, where_).data() + sparse.values.byteOffset;
  for (std::size_t i = 0; i < entries; ++i) {
    if (places[i] >= count()) {
      document_.fail(where_ + ".sparse.indices",
                     fmt::format("index {}, expected less than {}", places[i], count()));
    }
    convert(accessor_.componentType, values + i * element_size_, element_size_, {}, 1, components_,
            components_, normalized, rows + places[i] * static_cast<std::size_t>(components_));
  }
}

void AccessorReader::read_indices(std::uint32_t* out) const {
  if (accessor_.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor_.componentType)) {
    document_.fail(where_,
                   fmt::format("{} components of type {} for indices, expected 1 of 5121, 5123 or 5125",
                               components_, accessor_.componentType));
  }
  if (document_.is_view(accessor_.bufferView)) {
    copy_indices(accessor_.componentType,
                 document_.view(accessor_.bufferView, where_).data() + accessor_.byteOffset, stride_, count(),
                 out);
  } else {
    std::fill_n(out, count(), 0u);
  }
  if (!accessor_.sparse.isSparse) return;
  const auto& sparse = accessor_.sparse;
  const std::size_t entries = static_cast<std::size_t>(sparse.count);
  std::vector<std::uint32_t> places(entries);
  std::vector<std::uint32_t> values(entries);
  copy_indices(sparse.indices.componentType,
               document_.view(sparse.indices.bufferView, where_).data() + sparse.indices.byteOffset,
               component_size(sparse.indices.componentType), entries, places.data());
  copy_indices(accessor_.componentType,
               document_.view(sparse.values.bufferView, where_).data() + sparse.values.byteOffset,
               element_size_, entries, values.data());
  for (std::size_t i = 0; i < entries; ++i) {
    if (places[i] >= count()) {
      document_.fail(where_ + ".sparse.indices",
                     fmt::format("index {}, expected less than {}", places[i], count()));
    }
    out[places[i]] = values[i];
  }
}

void check_accessors(const Document& document) {
  for (std::size_t i = 0; i < document.model().accessors.size(); ++i)
    AccessorReader(document, static_cast<int>(i));
}

}  // namespace gatelight::scene::gltf
