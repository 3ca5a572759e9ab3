// What acts on the particles during a step, in the order in which it does.
#pragma once

#include "snowshed/methods/mps/state.hpp"

namespace snowshed {

/// Sorts the particles by cells, and finds neighbours, walls, number densities and the free surface
/// where they stand.
template <int D>
void find_neighbours(const MpsModel<D>&, MpsParticles<D>&, double time, MpsWork<D>&);

/// The shear rates and apparent viscosities, from the present velocities and pressures.
template <int D>
void find_viscosities(const MpsModel<D>&, MpsParticles<D>&, MpsWork<D>&);

/// Adds gravity and solves for the velocities that viscosity leaves, equation (10) with an implicit
/// viscous term. A solve that has not converged leaves the velocities unsound.
template <int D>
SolveReport apply_viscosity(const MpsModel<D>&, double dt, MpsParticles<D>&, MpsWork<D>&);

/// Solves the pressure equation (18). A solve that has not converged leaves the pressures unsound.
template <int D>
SolveReport solve_pressure(const MpsModel<D>&, double dt, MpsParticles<D>&, MpsWork<D>&);

/// Adds to the velocities what the pressure does to them, equation (15), and keeps particles from
/// entering walls within the step. What was added is left in `change`.
template <int D>
void apply_pressure(const MpsModel<D>&, double dt, MpsParticles<D>&, MpsWork<D>&);

/// Keeps particles apart as the settings say.
template <int D>
void keep_spacing(const MpsModel<D>&, double dt, MpsParticles<D>&, MpsWork<D>&);

/// Erodible particles begin to move, and moving ones are deposited, equation (23).
template <int D>
void erode_and_deposit(const MpsModel<D>&, MpsParticles<D>&, MpsWork<D>&);

/// The friction of a wall: the factor of a particle's velocity along the wall in its deceleration,
/// 1/s.
template <int D>
double wall_drag(const MpsModel<D>&, const MpsParticles<D>&, const MpsWork<D>&,
                 std::size_t particle, const WallContact<D>&);

}  // namespace snowshed
