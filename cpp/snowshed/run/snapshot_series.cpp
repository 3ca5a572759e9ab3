#include "snowshed/run/snapshot_series.hpp"

#include <cmath>
#include <cstdio>

#include "snowshed/io/vtp_writer.hpp"

namespace snowshed::run {
void write_particles(const std::filesystem::path& file, const methods::Method& method) {
  const methods::PointCloud cloud = method.snapshot();
  io::write_vtp(file, cloud.points, cloud.arrays, cloud.lines);
}

SnapshotSeries::SnapshotSeries(std::filesystem::path folder, double interval, double time)
    : folder_(std::move(folder)),
      interval_(interval),
      // On multiples of the interval, so that a resumed run writes the same snapshots.
      next_(std::ceil(time / interval - 1e-9) * interval),
      series_((std::filesystem::create_directories(folder_),
               io::PvdSeries::reopen(folder_ / "snapshots.pvd", next_))) {}

void SnapshotSeries::write(const methods::Method& method) {
  char name[32];
  std::snprintf(name, sizeof name, "snapshot_%06lld.vtp",
                static_cast<long long>(std::llround(next_ / interval_)));
  write_particles(folder_ / name, method);
  series_.append(method.time(), name);
  while (next_ <= method.time()) next_ += interval_;
}

}  // namespace snowshed::run
