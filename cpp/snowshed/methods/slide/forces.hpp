// The forces on the particles of a slide during a step.
#pragma once

#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {

/// Applies the mixing of velocities, gravity, friction, entrainment, and resistance and detrainment
/// in forest, one particle at a time. Changes velocities and masses.
void apply_ground(const Model&, State&, Workspace&);

/// Finds the forces between particles: the gradient of the snow's own pressure by smoothed particle
/// hydrodynamics, along the ground or, in compatible mode, along the map (see
/// kernels/surface_pressure.hpp and kernels/map_pressure.hpp), and the forces of the bonds. Marks
/// the bonds that are strained too much.
void apply_neighbours(const Model&, State&, Workspace&);

/// Marks the particles of which forest took all mass as removed, after they have moved.
void mark_detrained(const Model&, State&, Workspace&);

/// Removes the bonds that are marked.
void remove_broken(State&, Workspace&);

}  // namespace snowshed::methods::slide
