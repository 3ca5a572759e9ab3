// Particle snapshots during a run, as a series that ParaView opens as an animation.
#pragma once

#include <filesystem>

#include "snowshed/io/pvd_series.hpp"
#include "snowshed/methods/method.hpp"

namespace snowshed::run {

/// Writes the method's fields of its particles, in SI units: at least the velocity.
void write_particles(const std::filesystem::path& file, const methods::Method&);

class SnapshotSeries {
 public:
  /// Continues a series that is already in `folder`, from `time` on.
  SnapshotSeries(std::filesystem::path folder, double interval, double time);

  bool due(double time) const { return time >= next_; }
  double next() const { return next_; }  ///< time (s) of the next snapshot
  void write(const methods::Method&);

 private:
  std::filesystem::path folder_;
  double interval_, next_;
  io::PvdSeries series_;
};

}  // namespace snowshed::run
