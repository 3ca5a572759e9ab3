// Particles as an OpenVDB file: the solid they fill, its density, and the points themselves.
#pragma once

#include <string>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/io/vtp_writer.hpp"

namespace snowshed {

struct ParticleCloud {
  std::vector<Vec3> positions;         // m; y = 0 in 2D
  std::vector<double> masses;          // kg (per metre of width in 2D)
  std::vector<PointArray> attributes;  // of floats or 32-bit integers, with 1 or 3 components
};

struct VdbWriting {
  int dimension = 3;
  double voxel = 0;   // m, of the simulation
  double radius = 0;  // m, of a particle: see particle_radius
  double width = 0;   // m, in 2D: of the strip about y = 0 that stands for the plane
};

/// What was written.
struct VdbSummary {
  std::size_t surface_voxels = 0, density_voxels = 0;  // active ones
  double volume = 0;                                   // m3, of the solid
  double mass = 0;                                     // kg, of the density volume
};

/// Writes three grids, lengths in metres, z upward:
///
/// - "surface", level set: `particles_to_level_set`, its samples as they are, in a band of three
///   voxels of half the size of the simulation's;
/// - "density", fog volume, kg/m3: masses spread linearly over the eight nodes around each
///   particle, of the simulation's voxel size, so that the sum over the voxels is the mass;
/// - "particles": point data, with the radius as "pscale" and "velocity" as "v", the names that
///   Houdini expects.
///
/// In 2D, solid and density are drawn out along y over `width`; points stay in the plane.
/// Throws InputError where `particles_to_level_set` does, openvdb::Exception if it cannot write.
VdbSummary write_particles(const std::string& path, const ParticleCloud& cloud,
                           const VdbWriting& how);

}  // namespace snowshed
