#include "base/platform/control_group.h"

#include <algorithm>
#include <fstream>

namespace gatelight {
namespace {

namespace fs = std::filesystem;

/// The tightest limit from a group up to the root of its hierarchy. Inside a container the path may belong to
/// the host. Folders that are missing there have no limit, and the walk ends at the container's own group.
double tightest(const fs::path& mount, const std::string& group, const ReadLimit& read) {
  double limit = kUnlimited;
  fs::path relative = fs::path(group).relative_path();
  while (true) {
    limit = std::min(limit, read(mount / relative));
    if (relative.empty()) return limit;
    relative = relative.parent_path();
  }
}

}  // namespace

double tightest_limit(const fs::path& root, const std::string& controller, const ReadLimit& v2,
                      const ReadLimit& v1) {
  const fs::path mount = root / "sys/fs/cgroup";
  double limit = kUnlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  // Each line has the form hierarchy:controllers:path.
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      limit = std::min(limit, tightest(mount, group, v2));
    } else if (("," + controllers + ",").find("," + controller + ",") != std::string::npos) {
      limit = std::min(limit, tightest(mount / controller, group, v1));
      limit = std::min(limit, tightest(mount / controllers, group, v1));
    }
  }
  return limit;
}

}  // namespace gatelight
