#include "base/platform/threads.h"

#include <fmt/format.h>

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "base/platform/control_group.h"

namespace gatelight {
namespace {

namespace fs = std::filesystem;

/// The stack size that oneTBB gives its workers on 64-bit machines.
constexpr std::size_t kStackBytes = std::size_t{4} << 20;

double quota_of(double quota, double period) {
  return quota > 0.0 && period > 0.0 ? quota / period : kUnlimited;
}

/// The file holds "max 100000" or "150000 100000".
double read_quota_v2(const fs::path& folder) {
  std::ifstream file(folder / "cpu.max");
  double quota = 0.0;
  double period = 0.0;
  // "max" is not a number and means no limit.
  return file >> quota >> period ? quota_of(quota, period) : kUnlimited;
}

double read_quota_v1(const fs::path& folder) {
  std::ifstream quota_file(folder / "cpu.cfs_quota_us");
  std::ifstream period_file(folder / "cpu.cfs_period_us");
  double quota = 0.0;
  double period = 0.0;
  // A quota of -1 means no limit.
  return quota_file >> quota && period_file >> period ? quota_of(quota, period) : kUnlimited;
}

int affinity_count() {
#if defined(__linux__)
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

double cgroup_cpu_quota(const fs::path& root) {
  const double quota = tightest_limit(root, "cpu", read_quota_v2, read_quota_v1);
  return std::isfinite(quota) ? quota : 0.0;
}

int available_threads(const fs::path& root) {
  const int cpus = affinity_count();
  const double quota = cgroup_cpu_quota(root);
  if (quota <= 0.0 || quota >= static_cast<double>(cpus)) return cpus;
  return std::max(1, static_cast<int>(std::ceil(quota)));
}

void require_threads(int threads) {
  static std::atomic<int> started{1};
  if (threads <= started) return;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  // All threads exist at once, each with the memory that its first allocation takes.
  std::mutex gate;
  std::vector<pthread_t> trial;
  int failed = 0;
  {
    const std::lock_guard closed(gate);
    const auto wait = [](void* mutex) -> void* {
      std::free(std::malloc(1));
      const std::lock_guard open(*static_cast<std::mutex*>(mutex));
      return nullptr;
    };
    trial.reserve(static_cast<std::size_t>(threads));
    while (static_cast<int>(trial.size()) + 1 < threads && failed == 0) {
      pthread_t thread{};
      failed = pthread_create(&thread, &attributes, wait, &gate);
      if (failed == 0) trial.push_back(thread);
    }
  }
  for (const pthread_t thread : trial) pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  if (failed != 0) {
    throw OutOfMemory(fmt::format("`threads` {}: only {} can be started here ({})", threads, trial.size() + 1,
                                  std::generic_category().message(failed)));
  }
  started = threads;
}

}  // namespace gatelight
