#pragma once
// An opened glTF file: the checked JSON, and the bytes behind its buffers.

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "scene/gltf/container.h"
#include "scene/gltf/json.h"
#include "scene/gltf/uri.h"

namespace gatelight::scene::gltf {

class Document {
 public:
  /// Opens the file and checks everything that needs no decoding: schema, extensions, buffers, and that every
  /// buffer view lies in its buffer. Throws InputError.
  Document(const std::filesystem::path& path, bool allow_external, Warnings& warnings);

  const json& root() const { return root_; }
  /// A list of the root, such as "nodes"; empty if the file has none.
  const json& list(const char* name) const;
  /// An element of such a list.
  const json& item(const char* list_name, int index) const { return element(list(list_name), index); }
  const std::string& file() const { return file_; }
  /// The bytes behind a URI of this file. Throws InputError.
  OwnedBytes read(std::string_view uri, std::string_view where) const {
    return read_uri(uri, uris_, file_, where);
  }
  /// Call this, from one thread, before allocating `bytes` because of a count in the file. Throws InputError
  /// if the sum of all calls is implausible for a file of this size: a huge count needs only a few
  /// characters.
  void claim(std::size_t bytes, std::string_view where) const;

  /// Bytes of a buffer view, decompressed if necessary. Thread-safe. Throws InputError.
  Bytes view(int index, std::string_view where) const;

  [[noreturn]] void fail(std::string_view where, std::string_view what) const {
    throw make_error(file_, where, what);
  }

 private:
  struct Buffer {
    OwnedBytes storage;  ///< empty if the bytes belong to the .glb
    Bytes bytes;         ///< byteLength bytes; empty for a placeholder
  };

  void check_descriptions() const;
  void load_buffers();
  void check_views() const;
  /// The bytes at a place that has a buffer, an offset and a length.
  Bytes range(const json& place, std::string_view where) const;

  std::string file_;
  UriOptions uris_;
  Container container_;
  json root_;
  std::vector<Buffer> buffers_;
  std::size_t read_bytes_ = 0;               ///< size of the file and its buffers
  mutable std::size_t claimed_ = 0;          ///< sum of all claims, bytes
  mutable std::mutex mutex_;                 ///< guards decoded_
  mutable std::vector<OwnedBytes> decoded_;  ///< contents of compressed views, by view index
};

}  // namespace gatelight::scene::gltf
