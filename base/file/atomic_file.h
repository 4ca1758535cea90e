#pragma once
// Writes files that are either complete or absent. The data goes to an unnamed file, or to a temporary file
// in the same folder if the file system requires a name. Finally, the file gets its real name.

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "base/errors.h"

namespace gatelight {

/// Returns the path that a write to `path` replaces. Symbolic links are followed to their target, which need
/// not exist.
std::filesystem::path replaced_file(std::filesystem::path path);

/// Throws OutputError unless a file can be made at `path`: its folder exists and can be written, and the path
/// is free or holds a regular file. Call it before the long work.
void check_writable(const std::filesystem::path& path);

/// A file that is being written. An old file of the same name stays unchanged until commit(). A symbolic link
/// is followed and stays a link.
class AtomicFile {
 public:
  /// Throws OutputError.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// A seekable binary stream. Do not close it.
  std::FILE* stream() const { return stream_; }
  void write(const void* data, std::size_t bytes);

  /// Flushes the data to the disk and gives the file its name. Throws OutputError.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool named_ = false;  ///< whether temporary_ exists
  std::FILE* stream_ = nullptr;
};

/// Writes a small file at once. Throws OutputError.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace gatelight
