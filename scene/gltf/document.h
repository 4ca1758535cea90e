#pragma once
// An opened glTF file: the checked JSON as tinygltf's model, and the bytes behind its buffers.
//
// tinygltf reads the JSON only. It would copy a .glb's binary chunk, open any file that a URI names, and read
// image bytes without a range check. Buffers and images are therefore removed from its input and read here.

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "scene/gltf/container.h"
#include "scene/gltf/tinygltf.h"
#include "scene/gltf/uri.h"

namespace gatelight::scene::gltf {

struct ImageSource {
  std::string name;
  std::string uri;
  int buffer_view = -1;
};

class Document {
 public:
  /// Opens the file and checks what needs no decoding: schema, extensions, buffers, and that every buffer
  /// view lies in its buffer. Throws SceneError.
  Document(const std::filesystem::path& path, bool allow_external, Warnings& warnings);

  const tinygltf::Model& model() const { return model_; }
  const std::vector<ImageSource>& images() const { return images_; }
  const std::string& file() const { return file_; }
  /// The bytes behind a URI of this file. Throws SceneError.
  OwnedBytes read(std::string_view uri, std::string_view where) const {
    return read_uri(uri, uris_, file_, where);
  }
  /// Call this, from one thread, before allocating `bytes` because of a count in the file. Throws SceneError
  /// if the sum of all calls is implausible for a file of this size: a huge count needs only a few
  /// characters.
  void claim(std::size_t bytes, std::string_view where) const;

  /// Whether an accessor's view exists. tinygltf refuses index accessors without a buffer view, so in its
  /// model an index behind the file's last view means "none".
  bool is_view(int index) const { return index >= 0 && static_cast<std::size_t>(index) < view_count_; }

  /// Bytes of a buffer view, decompressed if necessary. Thread-safe. Throws SceneError.
  Bytes view(int index, std::string_view where) const;
  /// Length of view(index), without decompressing it.
  std::size_t view_size(int index) const {
    return model_.bufferViews[static_cast<std::size_t>(index)].byteLength;
  }
  std::size_t view_stride(int index) const {
    return model_.bufferViews[static_cast<std::size_t>(index)].byteStride;
  }

  [[noreturn]] void fail(std::string_view where, std::string_view what) const {
    throw make_error(file_, where, what);
  }

 private:
  struct Buffer {
    OwnedBytes storage;  ///< empty if the bytes belong to the .glb
    Bytes bytes;         ///< exactly byteLength bytes if present
    std::size_t length = 0;
    bool present = false;
  };
  struct Json;

  void load_buffers(const Json& json);
  void check_views() const;
  Bytes range(int buffer, std::size_t offset, std::size_t length, std::string_view where) const;

  std::string file_;
  UriOptions uris_;
  Container container_;
  std::vector<Buffer> buffers_;
  std::vector<ImageSource> images_;
  std::size_t view_count_ = 0;
  std::size_t read_bytes_ = 0;       ///< size of the file and its buffers
  mutable std::size_t claimed_ = 0;  ///< sum of all claims, bytes
  tinygltf::Model model_;
  mutable std::mutex mutex_;                 ///< guards decoded_
  mutable std::vector<OwnedBytes> decoded_;  ///< contents of compressed views, by view index
};

}  // namespace gatelight::scene::gltf
