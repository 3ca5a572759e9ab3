// The forces on the particles of a slide during a step.
#pragma once

#include "snowshed/methods/slide/state.hpp"

namespace snowshed {

/// The mixing of velocities, gravity, friction, resistance and entrainment: one particle at a time.
/// Changes velocities, and masses where snow is entrained.
void apply_ground(const SlideModel&, SlideState&, SlideWork&);

/// The gradient of the snow's own pressure, by smoothed particle hydrodynamics: along the ground,
/// or, in compatible mode, along the map. See kernels/surface_pressure.hpp and
/// kernels/map_pressure.hpp.
void add_pressure(const SlideModel&, SlideState&, SlideWork&);

/// The forces of the bonds. Breaks those that are strained too much.
void add_bonds(const SlideModel&, SlideState&, SlideWork&);

}  // namespace snowshed
