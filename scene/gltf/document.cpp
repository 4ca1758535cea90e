#include "scene/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "scene/gltf/meshopt.h"
#include "scene/gltf/validate.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// One byte of a buffer becomes at most 76 bytes of a mesh, unless primitives share accessors: an 8-bit index
/// becomes an index of 4 bytes and at most one vertex of 72. Scenes below kSmallScene bytes may share without
/// limit.
constexpr std::size_t kMaxPerByte = 256;
constexpr std::size_t kSmallScene = std::size_t{1} << 30;

/// The shortest node that shows a mesh has 10 characters, and 537 bytes in tinygltf's model.
constexpr std::size_t kMaxPerCharacter = 64;

/// Views that reach beyond the bytes that are there are refused where they are read.
void warn_of_length(std::size_t buffer, std::size_t found, std::size_t expected, Warnings& warnings) {
  if (found >= expected) return;
  warnings.add(fmt::format("buffers[{}]: {} bytes, expected {} (byteLength)", buffer, found, expected));
}

}  // namespace

Document::Document(const std::filesystem::path& path, const LoadOptions& options, Warnings& warnings)
    : file_(path.string()),
      uris_{path.parent_path(), options.allow_external},
      container_(open_container(path, warnings)),
      read_bytes_(container_.file.size()) {
  ValidatedJson validated = validate(container_.json, file_, options, warnings);
  json& root = validated.root;
  animations_ = std::move(validated.animations);
  channels_ = std::move(validated.channels);
  check_model_size(model_bytes(root));
  take_binary(root, warnings);
  model_ = read_model(std::move(root), file_, [&](std::size_t i, const std::string& uri, std::size_t length) {
    return read_buffer(i, uri, length, warnings);
  });
  for (const tinygltf::Buffer& buffer : model_.buffers) buffers_.emplace_back(buffer.data);
  if (!container_.binary.empty()) buffers_[0] = container_.binary;
  decoded_.resize(model_.bufferViews.size());
}

void Document::check_model_size(std::size_t bytes) const {
  const std::size_t text = container_.json.size();
  const std::size_t most = std::max(kSmallScene, text * kMaxPerCharacter);
  if (bytes <= most) return;
  fail("JSON", fmt::format("objects of {} MiB in memory, expected at most {} for a text of {} bytes",
                           bytes >> 20, most >> 20, text));
}

/// Keeps the file's bytes only if its first buffer is the .glb's BIN chunk.
void Document::take_binary(const json& root, Warnings& warnings) {
  const auto buffers = root.find("buffers");
  const bool used =
      container_.has_binary && buffers != root.end() && !buffers->empty() && !(*buffers)[0].contains("uri");
  if (!used) {
    container_ = {};
    return;
  }
  const std::size_t length = (*buffers)[0]["byteLength"];
  warn_of_length(0, container_.binary.size(), length, warnings);
  container_.binary = container_.binary.first(std::min(length, container_.binary.size()));
}

OwnedBytes Document::read_buffer(std::size_t index, const std::string& uri, std::size_t length,
                                 Warnings& warnings) {
  OwnedBytes bytes = read(uri, fmt::format("buffers[{}].uri", index), warnings);
  read_bytes_ += bytes.size();
  warn_of_length(index, bytes.size(), length, warnings);
  bytes.resize(std::min(length, bytes.size()));
  return bytes;
}

void Document::claim(std::size_t bytes, std::string_view where) const {
  const std::size_t most = std::max(kSmallScene, read_bytes_ * kMaxPerByte);
  if (bytes <= most && claimed_ <= most - bytes) {
    claimed_ += bytes;
    return;
  }
  fail(where, fmt::format("{:.0f} MiB of vertices, triangles, instances and keys so far, expected at most {} "
                          "for a file of {} bytes including its buffers",
                          (static_cast<double>(claimed_) + static_cast<double>(bytes)) / 0x1p20, most >> 20,
                          read_bytes_));
}

Bytes Document::range(int buffer, std::size_t offset, std::size_t length, std::string_view where) const {
  const Bytes source = element(buffers_, buffer);
  if (source.empty()) {
    fail(where, fmt::format("buffer {} has no data, expected a uri or a BIN chunk", buffer));
  }
  if (offset > source.size() || length > source.size() - offset) {
    fail(where, fmt::format("{} bytes at {}, expected at most {} (buffer {})", length, offset, source.size(),
                            buffer));
  }
  return source.subspan(offset, length);
}

Bytes Document::view(int index, std::string_view where) const {
  const tinygltf::BufferView& view = element(model_.bufferViews, index);
  const auto* const used = std::find_if(std::begin(kMeshoptNames), std::end(kMeshoptNames),
                                        [&](const char* name) { return view.extensions.count(name) > 0; });
  if (used == std::end(kMeshoptNames)) return range(view.buffer, view.byteOffset, view.byteLength, where);

  const std::lock_guard lock(mutex_);
  OwnedBytes& decoded = decoded_[static_cast<std::size_t>(index)];
  if (decoded.empty()) {
    const std::string place = fmt::format("bufferViews[{}].extensions.{}", index, *used);
    const tinygltf::Value& meshopt = *find_extension(view.extensions, *used);
    const Bytes source = range(integer_or(meshopt, "buffer", 0), size_of(meshopt, "byteOffset"),
                               size_of(meshopt, "byteLength"), place);
    decoded = decode_meshopt(source, meshopt, view.byteLength, file_, place);
  }
  return decoded;
}

}  // namespace gatelight::scene::gltf
