// The pressure of the snow around, as the default mode has it: along the ground, not along the map.
#pragma once

#include "snowshed/methods/slide/state.hpp"

namespace snowshed {

/// Adds what the gradient of thickness along the ground does to each particle.
///
/// A particle has the thickness h_k = sum_l (m_l / rho) W(r_kl), with the spiky kernel W (Mueller
/// et al. 2003) as wide as a cell and the distance r_kl in space, so that h is normal to the
/// ground. Snow has the potential energy sum_k m_k g n_z h_k / 2, with the ground's normal n. What
/// it exerts along the ground follows from it: two particles push each other with opposite forces
/// (Monaghan 2005, doi:10.1088/0034-4885/68/8/R01). Where a particle has so few neighbours that the
/// sum falls short of the integral, its pressure is raised by what is missing, at most twofold.
void add_surface_pressure(const SlideModel&, const SlideState&, SlideWork&);

/// The energy sum_k m_k g n_z h_k / 2, J: that by which the snow's centre of mass lies above the
/// ground.
double pressure_energy(const SlideModel&, const SlideState&, const SlideWork&);

}  // namespace snowshed
