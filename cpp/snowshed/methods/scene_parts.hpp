// The parts of a scene that methods read: plain data in SI units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "snowshed/geometry/polygon.hpp"
#include "snowshed/sampling/seeding.hpp"

namespace snowshed::methods {

/// A hole in an area.
struct HoleSpec {
  geometry::Ring outline;  // m, in the terrain's coordinates
};

/// An area on the map.
struct AreaSpec {
  std::string name;
  geometry::Ring outline;  // m, in the terrain's coordinates
  std::vector<HoleSpec> holes;
  double thickness = 0.0;  // m of snow, normal to the ground
};

/// An area that holds snow back.
struct ResistanceSpec {
  std::string name;
  geometry::Ring outline;
  std::vector<HoleSpec> holes;
};

/// Snow that enters an area at one time.
struct PulseSpec {
  double time = 0.0;       // s
  double thickness = 0.0;  // m, normal to the ground
  double speed = 0.0;      // m/s, down the slope
};

/// Snow that enters an area at given times.
struct InflowSpec {
  std::string name;
  geometry::Ring outline;
  std::vector<HoleSpec> holes;
  bool bonds = false;
  std::vector<PulseSpec> hydrograph;
};

/// A corner of a dam's line on the map.
struct DamCornerSpec {
  double x = 0.0, y = 0.0;  // m, in the terrain's coordinates
  double height = 0.0;      // m, of the crown above the ground
};

struct DamSpec {
  std::string name;
  std::vector<DamCornerSpec> corners;
  double slope = 90.0;       // degrees, of its face
  double restitution = 0.0;  // share of the speed that snow keeps
};

/// Ground from a raster of elevations, and the areas on it.
struct TerrainSpec {
  std::string file;  // ESRI ASCII grid
  std::string crs;   // coordinate reference system of raster and areas; results are written in it
  bool single_precision = true;  // rounds elevations in compatible mode
  std::string thickness_file;  // thicknesses of the release, in place of the areas'; an ASCII grid
  double max_thickness = 10;   // m, of the snow in the areas
  double max_slope = 70;       // degrees, of cliffs under a release
  std::string notes;           // assumptions about the files; results repeat them
  double release_speed = 0;    // m/s, of the released snow, down the slope
  std::vector<AreaSpec> release, secondary_release;
  std::vector<InflowSpec> inflows;
  std::vector<AreaSpec> entrainment;
  std::vector<ResistanceSpec> resistance;
  std::vector<DamSpec> dams;
};

/// Segmented snow to be loaded.
struct SampleSpec {
  std::string file;           // NPY, integers (nz, ny, nx): 0 air, any other number a grain
  double voxel_size = 0;      // m
  bool split_labels = false;  // whether each piece of a label is a grain
};

/// Motion in a stage of a loading. The bottom plate is fixed, the top plate can move, and the sides
/// are walls or periodic. In `isotropic` the speed is the rate of the height, and the stress is the
/// mean over top and sides. `hold` ends when the kinetic energy has fallen to 1e-4 of its peak in
/// the stage, or after the time in which the speed would cause the strain. `unload` also ends at
/// the strain.
enum class LoadingKind {
  compress,   // the top plate moves down
  unload,     // the top plate moves up, until the stress on it falls to `stress`
  stretch,    // the top plate moves up (bonded plates)
  shear,      // the top plate moves along x; at constant height, or under a constant normal stress
  isotropic,  // all six sides move inward at the same rate of strain (walls, or a shrinking period)
  penetrate,  // a cone is pushed down through the top, without a top plate
  hold        // nothing moves, until the kinetic energy has decayed
};

struct LoadingStage {
  LoadingKind kind = LoadingKind::compress;
  double speed = 0.02;  // m/s, of the moving parts
  double strain = 0.3;  // at the end of the stage: displacement over the sample's initial height
  double stress = 0;    // Pa; compress, isotropic: ends the stage if reached, 0: never;
                        // unload: see above; shear: normal stress, 0: constant height
};

/// The tip of a penetrometer: a cone with a shaft, along z.
struct Cone {
  double radius = 0.0025;  // m
  double half_angle = 30;  // degrees
};

/// Arrangement of the particles that fill snow.
struct Seeding {
  double particles_per_voxel = 0.0;  // 0: 6 in 2D, 8 in 3D
  sampling::SeedPattern pattern = sampling::SeedPattern::poisson;
  std::uint64_t seed = 1;
  bool allow_sparse = false;  // fewer than 4 (2D) or 6 (3D) per voxel
};

/// Treatment of the stack between two events.
enum class Between { carry, reseed };

/// Number of events, and the criteria that end an event.
struct Events {
  int count = 1;
  Between between = Between::carry;
  double max_time = 10.0;    // s, per event
  double rest_speed = 0.02;  // m/s
  double rest_time = 0.05;   // s
};

struct Output {
  double snapshot_interval = 0.0;  // s between particle snapshots; 0: only at the end of an event
  bool film = true;                // record the run, so that it can be viewed
  double film_interval = 0.0;      // s between its frames; 0: from the events' duration
  bool energy = false;             // keep the energy balance
  bool forces = false;             // record the forces on obstacles
  double force_interval = 0.01;    // s between the rows of their table
  double checkpoint_interval = 60.0;  // s of wall time between checkpoints; 0: none
};

}  // namespace snowshed::methods
