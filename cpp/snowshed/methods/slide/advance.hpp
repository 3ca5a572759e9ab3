// Moves the particles of a slide by the forces on them.
#pragma once

#include "snowshed/methods/slide/state.hpp"

namespace snowshed::slide {

/// New velocities and positions, brought back onto the ground. Particles that leave the terrain
/// are marked in `work.removed`. Updates the kinetic energy and whether the slide has stopped.
void advance(const Model&, State&, Workspace&);

/// Removes the marked particles and their bonds, and counts the mass that they carry.
void remove_marked(State&, Workspace&);

/// Splits particles that have become too heavy.
void split_heavy(const Model&, State&, Workspace&);

/// Stores the particles in the order of their cells. It reads only the cells' order from the
/// workspace, which does not follow. All or nothing.
void sort_by_cell(State&, Workspace&);

}  // namespace snowshed::slide
