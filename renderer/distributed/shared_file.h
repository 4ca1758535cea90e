#pragma once
// A file of rank 0 that the others read too.

#include <filesystem>

#include "renderer/distributed/ranks.h"

namespace gatelight::renderer {

/// A file that may lie in memory, as long as this object lives.
class SharedFile {
 public:
  SharedFile() = default;
  SharedFile(SharedFile&& other) noexcept;
  SharedFile& operator=(SharedFile&& other) noexcept;
  ~SharedFile();

  const std::filesystem::path& path() const { return path_; }

 private:
  friend SharedFile share_file(Ranks& ranks, const std::filesystem::path& path);

  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// All ranks call it; only rank 0 needs to have the file. Throws std::system_error where it cannot be read,
/// or where the memory of another rank has no room.
SharedFile share_file(Ranks& ranks, const std::filesystem::path& path);

}  // namespace gatelight::renderer
