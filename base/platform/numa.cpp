#include "base/platform/numa.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <sstream>
#include <string>

#if defined(__linux__)
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace gatelight {

unsigned long long nodes_of_list(const std::string& list) {
  unsigned long long nodes = 0;
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    std::istringstream range(part);
    int first = 0, last = 0;
    if (!(range >> first)) continue;
    last = first;
    if (range.peek() == '-') range.ignore() >> last;
    for (int node = std::max(first, 0); node <= last && node < 64; ++node) nodes |= 1ull << node;
  }
  return nodes;
}

int interleave_memory(const std::filesystem::path& root) {
#if defined(SYS_set_mempolicy) && defined(SYS_get_mempolicy)
  // Values of <linux/mempolicy.h>.
  constexpr int kDefault = 0, kInterleave = 3;
  constexpr unsigned long kMemsAllowed = 4, kBits = 64;
  std::ifstream file(root / "sys/devices/system/node/has_memory");
  std::string list;
  std::getline(file, list);
  int policy = kDefault;
  unsigned long allowed = 0;
  if (syscall(SYS_get_mempolicy, &policy, nullptr, 0ul, nullptr, 0ul) != 0 || policy != kDefault) return 1;
  if (syscall(SYS_get_mempolicy, nullptr, &allowed, kBits, nullptr, kMemsAllowed) != 0) return 1;
  const unsigned long nodes = static_cast<unsigned long>(nodes_of_list(list)) & allowed;
  if (std::popcount(nodes) < 2 || syscall(SYS_set_mempolicy, kInterleave, &nodes, kBits) != 0) return 1;
  return std::popcount(nodes);
#else
  static_cast<void>(root);
  return 1;
#endif
}

}  // namespace gatelight
