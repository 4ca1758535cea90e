#pragma once
// The number of threads that this process may use.

#include <filesystem>

namespace gatelight {

/// The smallest of the CPUs in the affinity mask and the CPU quotas of the process's control group and its
/// ancestors (cgroup v2: cpu.max; v1: cpu.cfs_quota_us over cpu.cfs_period_us), rounded up; at least 1.
/// `root` is the folder that holds proc and sys/fs/cgroup.
int available_threads(const std::filesystem::path& root = "/");

/// Only the quota, in CPUs; 0 means no quota.
double cgroup_cpu_quota(const std::filesystem::path& root = "/");

/// Throws OutOfMemory when this many threads cannot be started. oneTBB starts its threads later and would end
/// the program.
void require_threads(int threads);

}  // namespace gatelight
