// The message with which Python sends particles: a line of JSON, then plain arrays.
#pragma once

#include <istream>

#include "write_particles.hpp"

namespace snowshed {

struct WriteRequest {
  ParticleCloud cloud;
  VdbWriteSettings settings;
};

/// Reads a message. The line is {"particles", "dimension", "voxel", "particles_per_voxel", "width",
/// "attributes": [[name, "float32" or "int32", components], …]}. After the line break follow the
/// positions (n x 3 doubles), the masses (n doubles) and the attributes in turn, in the machine's
/// byte order. Throws InputError if the message is not of this form.
WriteRequest read_request(std::istream& in);

}  // namespace snowshed
