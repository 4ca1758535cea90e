#pragma once
// Memory of machines with several NUMA nodes: sockets, or parts of them, with memory of their own.

#include <filesystem>
#include <string>

namespace gatelight {

/// Spreads the memory that this thread, and threads that it starts from now on, touch for the first time over
/// all nodes that the process may use, page by page. A scene is read by one thread and then by all of them:
/// on the node of the one, its memory would serve the threads of every other node too. Returns the number of
/// nodes. Does nothing, and returns 1, on one node, on other systems than Linux, and where somebody has
/// chosen already (numactl). `root` is the folder that holds sys/devices/system/node.
int interleave_memory(const std::filesystem::path& root = "/");

/// The nodes in a list of the kernel's form, "0-1,4"; 64 and above are left out. One bit each.
unsigned long long nodes_of_list(const std::string& list);

}  // namespace gatelight
