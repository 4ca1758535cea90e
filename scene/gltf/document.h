#pragma once
// An opened glTF file: tinygltf's model of its checked JSON, and the bytes behind its buffers.

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "scene/gltf.h"
#include "scene/gltf/channels.h"
#include "scene/gltf/container.h"
#include "scene/gltf/model.h"
#include "scene/gltf/uri.h"

namespace gatelight::scene::gltf {

class Document {
 public:
  /// Opens the file, and checks what the shown scene refers to and what needs no decoding: schema,
  /// extensions, buffers, and that every buffer view lies in its buffer. Throws InputError.
  Document(const std::filesystem::path& path, const LoadOptions& options, Warnings& warnings);

  /// Its buffers that are part of a .glb are empty; view() has their bytes.
  const tinygltf::Model& model() const { return model_; }
  /// For the values that animations change. Its lists must keep their lengths.
  tinygltf::Model& model() { return model_; }
  const std::vector<Animation>& animations() const { return animations_; }
  /// Those of the chosen animations, for what the scene shows.
  const std::vector<Channel>& channels() const { return channels_; }
  const std::string& file() const { return file_; }
  /// The bytes behind a URI of this file. Throws InputError.
  OwnedBytes read(const std::string& uri, std::string_view where, Warnings& warnings) const {
    return read_uri(uri, uris_, file_, where, warnings);
  }
  /// Call this, from one thread, before allocating `bytes` because of a count in the file. Throws InputError
  /// if the sum of all calls is implausible for a file of this size: a huge count needs only a few
  /// characters.
  void claim(std::size_t bytes, std::string_view where) const;
  /// The sum of all claims, to return to it once their memory is free again.
  std::size_t claimed() const { return claimed_; }
  void return_to(std::size_t claimed) const { claimed_ = claimed; }

  /// Bytes of a buffer view, decompressed if necessary. Thread-safe. Throws InputError.
  Bytes view(int index, std::string_view where) const;

  [[noreturn]] void fail(std::string_view where, std::string_view what) const {
    throw make_error(file_, where, what);
  }

 private:
  void check_model_size(std::size_t bytes) const;
  void take_binary(const nlohmann::json& root, Warnings& warnings);
  OwnedBytes read_buffer(std::size_t index, const std::string& uri, std::size_t length, Warnings& warnings);
  Bytes range(int buffer, std::size_t offset, std::size_t length, std::string_view where) const;

  std::string file_;
  UriOptions uris_;
  Container container_;
  std::vector<Animation> animations_;
  std::vector<Channel> channels_;
  tinygltf::Model model_;
  std::vector<Bytes> buffers_;               ///< byteLength bytes, or fewer; empty for a placeholder
  std::size_t read_bytes_ = 0;               ///< size of the file and its buffers
  mutable std::size_t claimed_ = 0;          ///< bytes
  mutable std::mutex mutex_;                 ///< guards decoded_
  mutable std::vector<OwnedBytes> decoded_;  ///< contents of compressed views, by view index
};

}  // namespace gatelight::scene::gltf
