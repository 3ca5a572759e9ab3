// Particle snapshots during a run, as a series that ParaView opens as an animation.
#pragma once

#include <filesystem>

#include "snowshed/io/pvd_series.hpp"
#include "snowshed/methods/method.hpp"

namespace snowshed {

/// Writes all of a solver's particles with velocity, mass (kg), event, density (kg/m3), pressure
/// (Pa), volumetric plastic strain, id and, where there are several, which snow it is. The material
/// point method adds the deviatoric stress and, of snow that yields, the preconsolidation pressure
/// (Pa); a slide adds thickness (m), speed (m/s) and the number of bonds, and its bonds as lines.
void write_particles(const std::filesystem::path& file, const Method&);

class SnapshotSeries {
 public:
  /// Goes on with a series that is already in `folder`, from `time` on.
  SnapshotSeries(std::filesystem::path folder, double interval, double time);

  bool due(double time) const { return time >= next_; }
  void write(const Method&);

 private:
  std::filesystem::path folder_;
  double interval_, next_;
  PvdSeries series_;
};

}  // namespace snowshed
