// Particles as they come from Python: a line of JSON, then plain arrays.
#pragma once

#include <istream>

#include "write_particles.hpp"

namespace snowshed {

struct WriteRequest {
  ParticleCloud cloud;
  VdbWriting how;
};

/// Reads {"particles", "dimension", "voxel", "particles_per_voxel", "width", "attributes":
/// [[name, "float32" or "int32", components], …]} and after the line break the positions (n x 3
/// doubles), the masses (n doubles) and the attributes in turn, as the machine writes numbers.
/// Throws InputError.
WriteRequest read_request(std::istream& in);

}  // namespace snowshed
