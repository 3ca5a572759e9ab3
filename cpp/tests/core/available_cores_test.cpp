#include "snowshed/core/available_cores.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "io/temporary_folder.hpp"

namespace snowshed {
namespace {

/// A folder with the files by which a kernel describes control groups.
class AvailableCores : public io::TemporaryFolder {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(path(file).parent_path());
    std::ofstream(path(file)) << text;
  }
  double quota() const { return core_quota(path("")); }
};

constexpr double none = std::numeric_limits<double>::infinity();

TEST_F(AvailableCores, AQuotaOfVersionTwoCounts) {
  write("proc/self/cgroup", "0::/batch/job\n");
  EXPECT_EQ(quota(), none);
  write("sys/fs/cgroup/batch/job/cpu.max", "max 100000\n");
  EXPECT_EQ(quota(), none);
  write("sys/fs/cgroup/batch/job/cpu.max", "250000 100000\n");
  EXPECT_EQ(quota(), 2.5);
  write("sys/fs/cgroup/batch/cpu.max", "150000 100000\n");  // a group above
  EXPECT_EQ(quota(), 1.5);
}

TEST_F(AvailableCores, TheTopmostGroupHasTheQuotaOfAContainer) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/cpu.max", "50000 100000\n");
  EXPECT_EQ(quota(), 0.5);
}

TEST_F(AvailableCores, AQuotaOfVersionOneCounts) {
  write("proc/self/cgroup", "5:cpuset:/other\n4:cpu,cpuacct:/job\n0::/\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/cpu/other/cpu.cfs_quota_us", "1000\n");
  write("sys/fs/cgroup/cpu/other/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(quota(), none);
  write("sys/fs/cgroup/cpu/job/cpu.cfs_quota_us", "300000\n");
  EXPECT_EQ(quota(), 3.0);
}

TEST_F(AvailableCores, NoFilesNoQuota) { EXPECT_EQ(quota(), none); }

TEST_F(AvailableCores, ThreadsAreGivenOrThoseOfTheEnvironmentOrAllCores) {
  const char* before = std::getenv("OMP_NUM_THREADS");
  const std::string restored = before ? before : "";
  setenv("OMP_NUM_THREADS", "3,2", 1);
  EXPECT_EQ(threads_to_use(0), 3);
  EXPECT_EQ(threads_to_use(7), 7);
  setenv("OMP_NUM_THREADS", "many", 1);
  EXPECT_EQ(threads_to_use(0), available_cores());
  unsetenv("OMP_NUM_THREADS");
  EXPECT_EQ(threads_to_use(0), available_cores());
  EXPECT_GE(available_cores(), 1);
  if (before) setenv("OMP_NUM_THREADS", restored.c_str(), 1);
}

}  // namespace
}  // namespace snowshed
