#pragma once
// Files that are whole or not there: written without a name, or under a temporary one in the same folder
// where the file system asks for it, then renamed.

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "neural/base/errors.h"

namespace gatelight::neural {

/// Where a file written to `path` will lie: at the end of its symbolic links, whether anything is there or
/// not.
std::filesystem::path replaced_file(std::filesystem::path path);

/// Throws OutputError unless a file can be made at `path`: its folder exists and can be written, and the path
/// is free or holds a regular file. Meant for the time before the long work.
void check_writable(const std::filesystem::path& path);

/// A file in the making. An old file of the same name stays whole until commit(); without commit() nothing
/// changes. A symbolic link is followed, so that the link itself stays.
class AtomicFile {
 public:
  /// Throws OutputError.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Seekable, for binary data. Do not close it.
  std::FILE* stream() const { return stream_; }
  void write(const void* data, std::size_t bytes);

  /// Flushes to the disk, renames. Throws OutputError.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool named_ = false;  ///< whether temporary_ is there
  std::FILE* stream_ = nullptr;
};

/// The whole of a small file at once.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace gatelight::neural
