#include "base/platform/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "base/platform/control_group.h"

namespace gatelight {
namespace {

namespace fs = std::filesystem;

/// Reads a file of one number; "max" means no limit.
double read_limit(const fs::path& file) {
  std::ifstream stream(file);
  double bytes = 0.0;
  return stream >> bytes && bytes > 0.0 ? bytes : kUnlimited;
}

double read_total(const fs::path& root) {
  std::ifstream file(root / "proc/meminfo");
  double kibibytes = 0.0;
  std::string name;
  double value = 0.0;
  std::string unit;
  while (file >> name >> value && std::getline(file, unit)) {
    if (name == "MemTotal:" || name == "SwapTotal:") kibibytes += value;
  }
  return kibibytes > 0.0 ? kibibytes * 1024.0 : kUnlimited;
}

}  // namespace

MemoryRoom memory_room(const fs::path& root) {
  std::ifstream statm(root / "proc/self/statm");
  double virtual_pages = 0.0;
  double resident_pages = 0.0;
  statm >> virtual_pages >> resident_pages;
  const auto page = static_cast<double>(::sysconf(_SC_PAGESIZE));

  MemoryRoom room;
  const auto narrow = [&room](double limit, double taken, std::string_view name) {
    const double left = limit > taken ? limit - taken : 0.0;
    if (left >= static_cast<double>(room.bytes)) return;
    room = {static_cast<std::size_t>(left), name};
  };
  narrow(read_total(root), resident_pages * page, "the machine");
  const double group = tightest_limit(
      root, "memory", [](const fs::path& folder) { return read_limit(folder / "memory.max"); },
      [](const fs::path& folder) { return read_limit(folder / "memory.limit_in_bytes"); });
  narrow(group, resident_pages * page, "the control group");
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    narrow(static_cast<double>(limit.rlim_cur), virtual_pages * page, "ulimit -v");
  }
  return room;
}

}  // namespace gatelight
