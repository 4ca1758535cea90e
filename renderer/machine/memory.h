#pragma once
// How much memory this process may still take.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string_view>

namespace gatelight::renderer {

struct MemoryRoom {
  std::size_t bytes = std::numeric_limits<std::size_t>::max();
  std::string_view limit = "the machine";  ///< what sets it
};

/// The least of what is left of the machine's memory with its swap, of the limits of the process's control
/// group and its ancestors (cgroup v2: memory.max; v1: memory.limit_in_bytes), and of its address space
/// (ulimit -v). What is not taken yet may be taken by others. `root` is where /proc and /sys/fs/cgroup are
/// looked for.
MemoryRoom memory_room(const std::filesystem::path& root = "/");

}  // namespace gatelight::renderer
