#pragma once
// The safetensors format: named tensors and a map of texts in one file that many programs can read. Eight
// bytes hold the length of a header in JSON, the header says where each tensor lies, then come the bytes of
// the tensors, without gaps.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gatelight::neural {

enum class TensorType : std::uint8_t { f16, f32, f64, u32, u64 };

std::size_t element_bytes(TensorType type);

/// A tensor to be written: row-major, its bytes in the memory of the caller.
struct TensorView {
  std::string name;
  TensorType type = TensorType::f32;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> data;
};

using Metadata = std::map<std::string, std::string>;

/// Takes the bytes of a file, one piece after the other.
using ByteSink = std::function<void(std::span<const std::byte>)>;

/// Wide elements come first, so that each tensor is aligned to its elements; else the order is kept. The same
/// tensors and metadata give the same bytes. `path` is for messages. Throws CacheFileError.
void write_safetensors(const ByteSink& sink, const std::filesystem::path& path,
                       std::span<const TensorView> tensors, const Metadata& metadata);

/// The same into a file. Written under a temporary name in the same folder and renamed: an old file stays
/// whole until the new one is. Follows a symbolic link.
void write_safetensors(const std::filesystem::path& path, std::span<const TensorView> tensors,
                       const Metadata& metadata);

/// A file whose header has been read and found sound: every tensor lies within the file, has as many bytes as
/// its shape asks for, and together they fill the file without gap or overlap.
class SafetensorsReader {
 public:
  /// Throws CacheFileError, with the file, the value and what was expected.
  explicit SafetensorsReader(const std::filesystem::path& path);

  const Metadata& metadata() const { return metadata_; }
  std::vector<std::string> names() const;
  /// For a tensor whose size the reader does not know beforehand: how many elements its one axis has. They
  /// lie in the file. Throws CacheFileError where the tensor is missing or of another type or rank.
  std::uint64_t length(const std::string& name, TensorType type) const;
  /// Throws CacheFileError where the tensor is missing or of another type or shape.
  void expect_shape(const std::string& name, TensorType type, std::span<const std::uint64_t> shape) const;
  /// Throws as expect_shape does.
  void read(const std::string& name, TensorType type, std::span<const std::uint64_t> shape,
            std::span<std::byte> out);

  /// The bytes of a tensor in pieces of kPieceBytes, the last one shorter: for digests.
  static constexpr std::size_t kPieceBytes = 1 << 20;
  void read_in_pieces(const std::string& name, const ByteSink& sink);

  /// Throws CacheFileError about this file, in one line: what the reason quotes of it may be anything.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  struct Entry {
    TensorType type = TensorType::f32;
    std::vector<std::uint64_t> shape;
    std::uint64_t begin = 0;  ///< in the file's data
    std::uint64_t end = 0;
  };

  const Entry& find(const std::string& name) const;
  void parse_header(const std::string& header, std::uint64_t data_bytes);

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t data_offset_ = 0;
  Metadata metadata_;
  std::map<std::string, Entry> entries_;
};

}  // namespace gatelight::neural
