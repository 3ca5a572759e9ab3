// Writing particles as an OpenVDB file: the solid that they fill, its density, and the points.
#pragma once

#include <string>
#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/io/vtp_writer.hpp"

namespace snowshed {

struct ParticleCloud {
  std::vector<Vec3> positions;  // m; y = 0 in 2D
  std::vector<double> masses;   // kg (per metre of width in 2D)
  // Arrays of floats or 32-bit integers, with 1 or 3 components.
  std::vector<io::PointArray> attributes;
};

struct VdbWriteSettings {
  int dimension = 3;
  double voxel = 0;   // m, cell size of the simulation
  double radius = 0;  // m, of a particle, see sampling::particle_radius
  double width = 0;   // m, in 2D: width of the extruded strip about y = 0
};

/// Summary of a written file.
struct VdbSummary {
  std::size_t surface_voxels = 0, density_voxels = 0;  // active voxels
  double volume = 0;                                   // m3, of the solid
  double mass = 0;                                     // kg, integral of the density
};

/// Writes three grids with lengths in metres and z upward:
///
/// - "surface", a level set: the samples of `particles_to_level_set` in a band of three voxels. Its
///   voxels have half the size of the simulation's.
/// - "density", a fog volume in kg/m3: each particle's mass is distributed linearly to the eight
///   nodes around it, so that the density integrates to the mass. Its voxels have the simulation's
///   size.
/// - "particles", point data: the radius is "pscale" and the velocity is "v", the names that
///   Houdini expects.
///
/// In 2D, solid and density are extruded along y over `width`; points stay in the plane. Throws
/// InputError as `particles_to_level_set`, and openvdb::Exception if it cannot write.
VdbSummary write_particles(const std::string& path, const ParticleCloud& cloud,
                           const VdbWriteSettings& settings);

}  // namespace snowshed
