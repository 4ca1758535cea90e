#include "scene/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "scene/gltf/color_filter.h"

namespace gatelight::scene::gltf {

OwnedBytes decode_meshopt(Bytes source, const tinygltf::Value& extension, std::size_t length,
                          std::string_view file, std::string_view where) {
  const std::size_t count = size_of(extension, "count");
  const std::size_t stride = size_of(extension, "byteStride");
  const std::string mode = text_or(extension, "mode", "");
  const std::string filter = text_or(extension, "filter", "NONE");
  const auto require = [&](bool fits, std::string_view what) {
    if (!fits) throw make_error(file, where, what);
  };

  const bool vertices = mode == "ATTRIBUTES";
  require(vertices ? stride % 4 == 0 : stride == 2 || stride == 4,
          fmt::format("byteStride {}, expected {}", stride, vertices ? "a multiple of 4" : "2 or 4"));
  require(mode != "TRIANGLES" || count % 3 == 0, fmt::format("count {}, expected a multiple of 3", count));
  require(count * stride == length,
          fmt::format("{} elements of {} bytes, expected {} bytes (byteLength of the view)", count, stride,
                      length));
  constexpr std::uint8_t kVersion1 = 0xa1;
  const bool version_1 = vertices && !source.empty() && source.front() == kVersion1;
  require(!version_1 || MESHOPTIMIZER_VERSION >= 230,
          fmt::format("data of codec version 1, expected version 0: libmeshoptimizer {}.{} is too old for it",
                      MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100));
  // The codecs spend at least 2 bits on 16 bytes of a vertex (version 1: on 256), and a byte on a triangle or
  // an index. Data that claims more is wrong and is refused before memory is allocated.
  require(count * stride / (version_1 ? 1024 : 64) <= source.size(),
          fmt::format("count {}, expected data for it", count));
  require(filter == "NONE" || vertices, fmt::format("filter {}, expected NONE with mode {}", filter, mode));
  require((filter != "OCTAHEDRAL" && filter != "COLOR") || stride == 4 || stride == 8,
          fmt::format("byteStride {}, expected 4 or 8", stride));
  require(filter != "QUATERNION" || stride == 8, fmt::format("byteStride {}, expected 8", stride));

  OwnedBytes out(length);
  int status = 0;
  if (vertices) {
    status = meshopt_decodeVertexBuffer(out.data(), count, stride, source.data(), source.size());
  } else if (mode == "TRIANGLES") {
    status = meshopt_decodeIndexBuffer(out.data(), count, stride, source.data(), source.size());
  } else {
    status = meshopt_decodeIndexSequence(out.data(), count, stride, source.data(), source.size());
  }
  require(status == 0,
          fmt::format("{} data that cannot be decoded (code {}), expected meshopt data", mode, status));

  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  if (filter == "COLOR") decode_color_filter(out, stride);
  return out;
}

}  // namespace gatelight::scene::gltf
