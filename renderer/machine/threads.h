#pragma once
// How many threads this process may use.

#include <filesystem>

namespace gatelight::renderer {

/// The smallest of the CPUs in the affinity mask and the CPU quotas of the process's control group and its
/// ancestors (cgroup v2: cpu.max; v1: cpu.cfs_quota_us over cpu.cfs_period_us), rounded up; at least 1.
/// `root` is where /proc and /sys/fs/cgroup are looked for.
int available_threads(const std::filesystem::path& root = "/");

/// The quota alone, in CPUs; 0 where there is none.
double cgroup_cpu_quota(const std::filesystem::path& root = "/");

/// Throws OutOfMemory where so many threads cannot be started: oneTBB, which starts them later and by itself,
/// would end the program.
void require_threads(int threads);

}  // namespace gatelight::renderer
