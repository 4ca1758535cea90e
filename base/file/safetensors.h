#pragma once
// The safetensors format: named tensors and a map of texts in one file that many programs can read. Eight
// bytes hold the length of a JSON header, which has the offset of each tensor. The bytes of the tensors
// follow without gaps.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gatelight {

enum class TensorType : std::uint8_t { f16, f32, f64, u32, u64 };

std::size_t element_bytes(TensorType type);

/// A tensor to write, row-major; the caller owns the bytes.
struct TensorView {
  std::string name;
  TensorType type = TensorType::f32;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> data;
};

using Metadata = std::map<std::string, std::string>;

/// Receives the bytes of a file piece by piece.
using ByteSink = std::function<void(std::span<const std::byte>)>;

/// Writes the content of a file to `sink`. Tensors with wide elements come first, so that each tensor is
/// aligned to its elements; else the order is kept. Equal tensors and metadata give equal bytes. `path` is
/// for messages. Throws OutputError.
void write_safetensors(const ByteSink& sink, const std::filesystem::path& path,
                       std::span<const TensorView> tensors, const Metadata& metadata);

/// Writes an AtomicFile.
void write_safetensors(const std::filesystem::path& path, std::span<const TensorView> tensors,
                       const Metadata& metadata);

/// Reads a file. The constructor checks the header: every tensor lies within the file and has the bytes that
/// its shape requires, and together the tensors fill the file without gap or overlap.
class SafetensorsReader {
 public:
  /// Throws CacheFileError, which names the file, the value and what was expected.
  explicit SafetensorsReader(const std::filesystem::path& path);

  const Metadata& metadata() const { return metadata_; }
  std::vector<std::string> names() const;
  /// Number of elements of a tensor with one axis, for callers that do not know its size. Throws
  /// CacheFileError if the tensor is missing or has another type or rank.
  std::uint64_t length(const std::string& name, TensorType type) const;
  /// Throws CacheFileError if the tensor is missing or has another type or shape.
  void expect_shape(const std::string& name, TensorType type, std::span<const std::uint64_t> shape) const;
  /// Throws as expect_shape does.
  void read(const std::string& name, TensorType type, std::span<const std::uint64_t> shape,
            std::span<std::byte> out);

  /// Passes the bytes of a tensor to `sink`, in pieces of kPieceBytes and a shorter last one, for digests.
  static constexpr std::size_t kPieceBytes = 1 << 20;
  void read_in_pieces(const std::string& name, const ByteSink& sink);

  /// Throws CacheFileError about this file, in one line, even if `reason` quotes arbitrary bytes of it.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  struct Entry {
    TensorType type = TensorType::f32;
    std::vector<std::uint64_t> shape;
    std::uint64_t begin = 0;  ///< offset in the file's data
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

}  // namespace gatelight
