#pragma once
// The memory that this process may still take.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string_view>

namespace gatelight {

struct MemoryRoom {
  std::size_t bytes = std::numeric_limits<std::size_t>::max();
  std::string_view limit = "the machine";  ///< what sets the limit
};

/// The smallest remainder of three limits: the machine's memory with its swap, the limits of the process's
/// control group and its ancestors (cgroup v2: memory.max; v1: memory.limit_in_bytes), and the address space
/// (ulimit -v). Other processes may take the same memory. `root` is the folder that holds proc and
/// sys/fs/cgroup.
MemoryRoom memory_room(const std::filesystem::path& root = "/");

}  // namespace gatelight
