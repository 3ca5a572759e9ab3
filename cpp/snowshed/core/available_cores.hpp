// The cores that this process may use.
#pragma once

#include <filesystem>

namespace snowshed {

/// The number of cores that this process may use: those of its affinity, or fewer if its control
/// group (a container, a batch job) has a quota of processor time. A quota of one and a half cores
/// counts as two.
int available_cores();

/// The quota of processor time of this process in cores, or infinity. `root` stands before the
/// system's paths.
double core_quota(const std::filesystem::path& root = "/");

/// The number of threads for a run: the given number, or with 0 that of OMP_NUM_THREADS, which
/// cluster schedulers set, or else one for each available core.
int threads_to_use(int wanted);

}  // namespace snowshed
