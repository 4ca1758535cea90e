#include "renderer/threads.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

namespace gatelight::renderer {
namespace {

namespace fs = std::filesystem;

/// "max 100000" or "150000 100000".
std::optional<double> read_quota_v2(const fs::path& folder) {
  std::ifstream file(folder / "cpu.max");
  double quota = 0.0;
  double period = 0.0;
  // "max" is not a number: no limit.
  if (!(file >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;
  return quota / period;
}

std::optional<double> read_quota_v1(const fs::path& folder) {
  std::ifstream quota_file(folder / "cpu.cfs_quota_us");
  std::ifstream period_file(folder / "cpu.cfs_period_us");
  double quota = 0.0;
  double period = 0.0;
  // -1: no limit.
  if (!(quota_file >> quota) || !(period_file >> period) || quota <= 0.0 || period <= 0.0) {
    return std::nullopt;
  }
  return quota / period;
}

/// The tightest limit from a group up to the root of its hierarchy. Inside a container the path may belong to
/// the host; its missing folders have no limit, and the walk ends at the container's own group.
template <typename Read>
double tightest(const fs::path& mount, const std::string& group, Read read) {
  double quota = std::numeric_limits<double>::infinity();
  fs::path relative = fs::path(group).relative_path();
  while (true) {
    if (const std::optional<double> found = read(mount / relative)) quota = std::min(quota, *found);
    if (relative.empty()) return quota;
    relative = relative.parent_path();
  }
}

bool lists_cpu(const std::string& controllers) {
  std::istringstream names(controllers);
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "cpu") return true;
  }
  return false;
}

int affinity_count() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

double cgroup_cpu_quota(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  double quota = std::numeric_limits<double>::infinity();
  std::ifstream groups(root / "proc/self/cgroup");
  // Each line: hierarchy:controllers:path
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      quota = std::min(quota, tightest(mount, group, read_quota_v2));
    } else if (lists_cpu(controllers)) {
      quota = std::min(quota, tightest(mount / "cpu", group, read_quota_v1));
      quota = std::min(quota, tightest(mount / controllers, group, read_quota_v1));
    }
  }
  return std::isfinite(quota) ? quota : 0.0;
}

int available_threads(const fs::path& root) {
  const int cpus = affinity_count();
  const double quota = cgroup_cpu_quota(root);
  if (quota <= 0.0 || quota >= static_cast<double>(cpus)) return cpus;
  return std::max(1, static_cast<int>(std::ceil(quota)));
}

}  // namespace gatelight::renderer
