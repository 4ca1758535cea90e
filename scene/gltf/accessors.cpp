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

bool is_matrix(int type) {
  return type == TINYGLTF_TYPE_MAT2 || type == TINYGLTF_TYPE_MAT3 || type == TINYGLTF_TYPE_MAT4;
}

/// Calls use(value) with a value of the component type.
template <typename Use>
auto with_type(int type, const Use& use) {
  switch (type) {
    case kByte:
      return use(std::int8_t{});
    case kUnsignedByte:
      return use(std::uint8_t{});
    case kShort:
      return use(std::int16_t{});
    case kUnsignedShort:
      return use(std::uint16_t{});
    case kUnsignedInt:
      return use(std::uint32_t{});
    default:
      return use(float{});
  }
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

void convert(int type, const std::uint8_t* base, std::size_t stride, Selection selection, std::size_t count,
             int components, int width, bool normalized, float* out) {
  const int n = std::min(components, width);
  with_type(type, [&](auto component) {
    using T = decltype(component);
    float* row = out;
    for (std::size_t i = 0; i < count; ++i, row += width) {
      const std::uint8_t* element = base + (selection.empty() ? i : selection[i]) * stride;
      for (int c = 0; c < n; ++c) {
        row[c] = to_float<T>(element + static_cast<std::size_t>(c) * sizeof(T), normalized);
      }
    }
  });
}

void copy_indices(int type, const std::uint8_t* base, std::size_t stride, std::size_t count,
                  std::uint32_t* out) {
  if (type == kUnsignedInt && stride == 4) {
    std::memcpy(out, base, count * 4);
    return;
  }
  with_type(type, [&](auto value) {
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&value, base + i * stride, sizeof value);
      out[i] = static_cast<std::uint32_t>(value);
    }
  });
}

}  // namespace

std::size_t component_size(int type) {
  return with_type(type, [](auto value) { return sizeof value; });
}

void to_floats(int type, const std::uint8_t* element, int count, bool normalized, float* out) {
  convert(type, element, 0, {}, 1, count, count, normalized, out);
}

AccessorReader::AccessorReader(const Document& document, int accessor)
    : document_(document),
      accessor_(element(document.model().accessors, accessor)),
      where_(fmt::format("accessors[{}]", accessor)),
      type_(accessor_.componentType),
      components_(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_.type))),
      count_(accessor_.count),
      element_size_(static_cast<std::size_t>(components_) * component_size(type_)),
      stride_(element_size_),
      place_{accessor_.bufferView, accessor_.byteOffset} {
  if (place_.view < 0) {
    if (count_ > kMaxZeros) {
      document.fail(where_,
                    fmt::format("count {} without a bufferView, expected at most {}", count_, kMaxZeros));
    }
  } else {
    const std::size_t stride = element(document.model().bufferViews, place_.view).byteStride;
    if (stride > 0) stride_ = stride;
    if (stride_ < element_size_) {
      document.fail(where_, fmt::format("byteStride {}, expected at least {}", stride_, element_size_));
    }
    check_range(place_, count_, stride_, element_size_, where_);
  }
  if (!accessor_.sparse.isSparse) return;
  const auto& indices = accessor_.sparse.indices;
  const auto& values = accessor_.sparse.values;
  sparse_count_ = static_cast<std::size_t>(accessor_.sparse.count);
  sparse_indices_ = {indices.bufferView, static_cast<std::size_t>(indices.byteOffset)};
  sparse_values_ = {values.bufferView, static_cast<std::size_t>(values.byteOffset)};
  index_type_ = indices.componentType;
  if (sparse_count_ > count_) {
    document.fail(where_ + ".sparse", fmt::format("count {}, expected at most {}", sparse_count_, count_));
  }
  const std::size_t index_size = component_size(index_type_);
  check_range(sparse_indices_, sparse_count_, index_size, index_size, where_ + ".sparse.indices");
  check_range(sparse_values_, sparse_count_, element_size_, element_size_, where_ + ".sparse.values");
}

void AccessorReader::check_range(const Place& place, std::size_t count, std::size_t stride,
                                 std::size_t element, std::string_view where) const {
  const std::size_t size = gltf::element(document_.model().bufferViews, place.view).byteLength;
  const bool fits = count == 0 || (place.offset <= size && element <= size - place.offset &&
                                   (count - 1) <= (size - place.offset - element) / stride);
  if (!fits) {
    document_.fail(where,
                   fmt::format("{} elements of {} bytes at {}, stride {}, expected to fit the {} bytes of "
                               "bufferViews[{}]",
                               count, element, place.offset, stride, size, place.view));
  }
}

bool AccessorReader::fits_attribute(std::initializer_list<int> components) const {
  return std::find(components.begin(), components.end(), components_) != components.end() &&
         !is_matrix(accessor_.type) && type_ != kUnsignedInt;
}

void AccessorReader::expect_attribute(std::string_view semantic,
                                      std::initializer_list<int> components) const {
  if (fits_attribute(components)) return;
  std::string wanted;
  for (const int n : components) wanted += fmt::format("{}{}", wanted.empty() ? "" : " or ", n);
  document_.fail(where_, fmt::format("{} components of type {} for {}, expected {} (not of type 5125)",
                                     components_, type_, semantic, wanted));
}

template <typename Write>
void AccessorReader::for_each_sparse(const Write& write) const {
  if (sparse_count_ == 0) return;
  std::vector<std::uint32_t> indices(sparse_count_);
  copy_indices(index_type_, data(sparse_indices_), component_size(index_type_), sparse_count_,
               indices.data());
  const std::uint8_t* element = data(sparse_values_);
  for (const std::uint32_t index : indices) {
    if (index >= count_) {
      document_.fail(where_ + ".sparse.indices",
                     fmt::format("index {}, expected less than {}", index, count_));
    }
    write(index, element);
    element += element_size_;
  }
}

void AccessorReader::read_floats(Selection selection, int width, float* out, bool force_normalized) const {
  const bool normalized = force_normalized || accessor_.normalized;
  const std::size_t rows = selection.empty() ? count_ : selection.size();
  if (rows == 0) return;
  if (sparse_count_ > 0) {
    // Sparse accessors are rare and small: the whole accessor is assembled, then the selection is read from
    // it.
    const std::size_t row = static_cast<std::size_t>(components_);
    std::vector<float> all(count_ * row, 0.0f);
    if (place_.view >= 0) {
      convert(type_, data(place_), stride_, {}, count_, components_, components_, normalized, all.data());
    }
    for_each_sparse([&](std::uint32_t index, const std::uint8_t* element) {
      to_floats(type_, element, components_, normalized, all.data() + index * row);
    });
    convert(kFloat, reinterpret_cast<const std::uint8_t*>(all.data()), row * sizeof(float), selection, rows,
            components_, width, false, out);
  } else if (place_.view >= 0) {
    convert(type_, data(place_), stride_, selection, rows, components_, width, normalized, out);
  } else {
    for (std::size_t i = 0; i < rows; ++i)
      std::fill_n(out + i * static_cast<std::size_t>(width), std::min(components_, width), 0.0f);
  }
}

void AccessorReader::read_indices(std::uint32_t* out) const {
  const bool fits = type_ == kUnsignedByte || type_ == kUnsignedShort || type_ == kUnsignedInt;
  if (components_ != 1 || !fits) {
    document_.fail(where_,
                   fmt::format("{} components of type {} for indices, expected 1 of 5121, 5123 or 5125",
                               components_, type_));
  }
  if (count_ == 0) return;
  if (place_.view >= 0) {
    copy_indices(type_, data(place_), stride_, count_, out);
  } else {
    std::fill_n(out, count_, 0u);
  }
  for_each_sparse([&](std::uint32_t index, const std::uint8_t* element) {
    copy_indices(type_, element, element_size_, 1, out + index);
  });
}

}  // namespace gatelight::scene::gltf
