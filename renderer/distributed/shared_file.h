#pragma once
// A file of rank 0 that the others read too.

#include <filesystem>
#include <memory>

#include "renderer/distributed/ranks.h"

namespace gatelight::renderer {

/// A file that may lie in memory, as long as this object lives.
struct SharedFile {
  std::filesystem::path path;
  std::shared_ptr<void> memory;
};

/// All ranks call it; only rank 0 needs to have the file. Throws std::system_error where it cannot be read,
/// or where the memory of another rank has no room.
SharedFile share_file(Ranks& ranks, const std::filesystem::path& path);

}  // namespace gatelight::renderer
