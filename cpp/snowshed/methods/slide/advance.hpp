// Moves the particles of a slide by the forces on them.
#pragma once

#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {

/// Computes new velocities and positions, and brings the positions back onto the ground. Particles
/// that leave the terrain are marked in `work.removed`. Updates the kinetic energy.
void advance(const Model&, State&, Workspace&);

/// Finds from the kinetic energy whether the slide has stopped.
void find_stop(const Model&, State&);

/// Removes the marked particles and their bonds. Counts their mass as `left_terrain`, unless forest
/// took it.
void remove_marked(State&, Workspace&);

/// Splits particles that have become too heavy.
void split_heavy(const Model&, State&, Workspace&);

/// Stores the particles in the order of their cells. Reads only the order of the cells from the
/// workspace. Refresh the workspace afterwards. Changes nothing if it throws.
void sort_by_cell(State&, Workspace&);

}  // namespace snowshed::methods::slide
