// Fills bodies of snow with particles of the MPS method, on a lattice.
#pragma once

#include <string>
#include <vector>

#include "snowshed/core/stop_request.hpp"
#include "snowshed/geometry/level_set.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/particle_batch.hpp"

namespace snowshed::methods::mps {

/// Fills a body with as many particles as its volume holds cells of the spacing. They share its
/// mass exactly, and their number is rounded, so each has about the mass of a cell. Adds a note if
/// the body is too small for that. Throws as `fill_lattice`.
void seed_on_lattice(const Settings&, const geometry::LevelSet& shape, int dimension,
                     const StopRequest& stop, ParticleBatch& batch,
                     std::vector<std::string>& notes);

}  // namespace snowshed::methods::mps
