#include "snowshed/core/available_cores.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

#include "snowshed/core/control_group.hpp"

namespace snowshed {
namespace {

constexpr double no_quota = std::numeric_limits<double>::infinity();

int cores_of_affinity() {
#ifdef __linux__
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
#endif
  return std::max(1, int(std::thread::hardware_concurrency()));
}

/// The quota of a control group in cores. A file that is missing, or says "max" or -1, sets none.
double quota_of(ControlGroups version, const std::filesystem::path& group) {
  double quota = 0, period = 0;
  if (version == ControlGroups::version2) {
    std::ifstream(group / "cpu.max") >> quota >> period;
  } else {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0 && period > 0 ? quota / period : no_quota;
}

int threads_of_environment() {
  const char* text = std::getenv("OMP_NUM_THREADS");
  return text ? std::atoi(text) : 0;
}

}  // namespace

double core_quota(const std::filesystem::path& root) {
  double quota = no_quota;
  for (const ControlGroups version : {ControlGroups::version1, ControlGroups::version2})
    for (const auto& group : control_group_folders(version, "cpu", root))
      quota = std::min(quota, quota_of(version, group));
  return quota;
}

int available_cores() {
  const int cores = cores_of_affinity();
  return int(std::clamp(std::ceil(core_quota()), 1.0, double(cores)));
}

int threads_to_use(int wanted) {
  if (wanted > 0) return wanted;
  const int given = threads_of_environment();
  return given > 0 ? given : available_cores();
}

}  // namespace snowshed
