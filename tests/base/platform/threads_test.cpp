#include "base/platform/threads.h"

#include <gtest/gtest.h>

#include <sched.h>

#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

using tests::TemporaryFolder;

TEST(CgroupQuota, V2IsTheTightestOfTheGroupAndItsAncestors) {
  const TemporaryFolder root;
  root.write("proc/self/cgroup", "0::/a/b\n");
  EXPECT_EQ(cgroup_cpu_quota(root.path()), 0.0);
  root.write("sys/fs/cgroup/a/b/cpu.max", "max 100000\n");
  EXPECT_EQ(cgroup_cpu_quota(root.path()), 0.0);
  root.write("sys/fs/cgroup/a/cpu.max", "250000 100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cpu_quota(root.path()), 2.5);
  root.write("sys/fs/cgroup/a/b/cpu.max", "50000 100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cpu_quota(root.path()), 0.5);
}

TEST(CgroupQuota, V2OfAContainerIsReadAtTheMount) {
  const TemporaryFolder root;
  root.write("proc/self/cgroup", "0::/\n");
  root.write("sys/fs/cgroup/cpu.max", "400000 100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cpu_quota(root.path()), 4.0);
}

TEST(CgroupQuota, V1IsReadFromTheCpuController) {
  const TemporaryFolder root;
  root.write("proc/self/cgroup", "5:memory:/x\n4:cpuset:/y\n3:cpu,cpuacct:/docker/f00\n");
  root.write("sys/fs/cgroup/cpu/docker/f00/cpu.cfs_quota_us", "-1\n");
  root.write("sys/fs/cgroup/cpu/docker/f00/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cgroup_cpu_quota(root.path()), 0.0);
  root.write("sys/fs/cgroup/cpu/docker/f00/cpu.cfs_quota_us", "150000\n");
  EXPECT_DOUBLE_EQ(cgroup_cpu_quota(root.path()), 1.5);
}

TEST(CgroupQuota, V1OfAHostPathThatIsNotMountedFallsBackToTheMount) {
  const TemporaryFolder root;
  root.write("proc/self/cgroup", "3:cpu,cpuacct:/host/only\n");
  root.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "300000\n");
  root.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cpu_quota(root.path()), 3.0);
}

TEST(CgroupQuota, AnInvalidQuotaIsNoLimit) {
  for (const char* content : {"", "x y\n", "-5 100000\n", "100000 0\n", "100000\n"}) {
    const TemporaryFolder root;
    root.write("proc/self/cgroup", "garbage\n0::/\n");
    root.write("sys/fs/cgroup/cpu.max", content);
    EXPECT_EQ(cgroup_cpu_quota(root.path()), 0.0) << content;
  }
  const TemporaryFolder empty;
  EXPECT_EQ(cgroup_cpu_quota(empty.path()), 0.0);
}

TEST(AvailableThreads, AQuotaBelowOneCpuIsOneThread) {
  const TemporaryFolder root;
  root.write("proc/self/cgroup", "0::/\n");
  root.write("sys/fs/cgroup/cpu.max", "20000 100000\n");
  EXPECT_EQ(available_threads(root.path()), 1);
}

TEST(AvailableThreads, FollowsTheAffinityMask) {
  const TemporaryFolder no_quota;
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(available_threads(no_quota.path()), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &before)) {
      CPU_SET(cpu, &one);
      break;
    }
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(available_threads(no_quota.path()), 1);
  sched_setaffinity(0, sizeof before, &before);
}

}  // namespace
}  // namespace gatelight
