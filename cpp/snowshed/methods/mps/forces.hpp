// Forces on the particles during a step, in the order in which they act.
#pragma once

#include <cmath>

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// Sorts the particles by cells, and finds neighbours, walls, number densities and the free
/// surface.
template <int D>
void find_neighbours(const Model<D>&, Particles<D>&, double time, Workspace<D>&);

/// The slope of each pair, or zero if the neighbour is of this kind or of a later one. The array is
/// valid until the next call.
template <int D>
const float* slope_without(Kind, const Model<D>&, const Particles<D>&, Neighbourhood<D>&);

/// The first moments, along the normal, of the weights that particles below the first layer lack
/// above the free surface.
template <int D>
void find_open_moments(const Model<D>&, const Particles<D>&, Neighbourhood<D>&);

/// The pressures from which yield stresses follow: the particles' pressures, smoothed and not
/// negative.
template <int D>
void smooth_pressures(const Model<D>&, const Particles<D>&, Workspace<D>&);

/// sqrt(2 D:D) of a velocity gradient, 1/s.
template <int D>
double shear_rate(const Eigen::Matrix<double, D, D>& gradient) {
  return (gradient + gradient.transpose()).norm() / std::sqrt(2.0);
}

/// Whether snow with this velocity is at rest: it has a yield stress, and is slower than a tenth of
/// the speed that gravity adds in a step.
template <int D>
bool rests(const Model<D>& model, double dt, const VecD<D>& velocity) {
  constexpr double max_share = 0.1;
  return !model.rheology.is_newtonian() && velocity.norm() < max_share * model.gravity.norm() * dt;
}

/// Prepares find_rates for the present positions of the particles.
template <int D>
void prepare_rates(const Model<D>&, const Particles<D>&, Workspace<D>&);

/// The sums of slope (u_j - u_i) r^T over each particle's neighbours, stored in `rates.gradient`.
template <int D>
void sum_velocity_gradients(const Model<D>&, const Particles<D>&, const float* slope,
                            Workspace<D>&);

/// The velocity gradients and shear rates of the present velocities.
template <int D>
void find_rates(const Model<D>&, Particles<D>&, Workspace<D>&);

/// The apparent viscosities of particles, from the shear rates and the smoothed pressures.
template <int D>
void find_viscosities(const Model<D>&, Particles<D>&, const Workspace<D>&);

/// Adds to the velocity of every moving particle its change by gravity in a step.
template <int D>
void add_gravity(const Model<D>&, double dt, Particles<D>&);

/// Replaces the velocities by those after a step with viscosity, which is implicit in equation
/// (10). A solve that has not converged leaves them unsound.
template <int D>
SolveReport apply_viscosity(const Model<D>&, double dt, Particles<D>&, Workspace<D>&);

/// Makes the matrix of the pressure equations of a step. If `hydrostatic`, the pressure is linear
/// up to the free surface; stiff fluids and snow have viscous stresses of their own there.
template <int D>
void prepare_pressure(const Model<D>&, const Particles<D>&, bool hydrostatic, Workspace<D>&);

/// Solves the pressure equation (18). A solve that has not converged leaves the pressures unsound.
template <int D>
SolveReport solve_pressure(const Model<D>&, double dt, Particles<D>&, Workspace<D>&);

/// Adds the effect of the pressure to the velocities, equation (15), and keeps particles from
/// entering walls within the step. `change` holds the change of the velocities.
template <int D>
void apply_pressure(const Model<D>&, double dt, Particles<D>&, Workspace<D>&);

/// Keeps particles apart by the rule that the settings name.
template <int D>
void keep_spacing(const Model<D>&, double dt, Particles<D>&, Workspace<D>&);

/// Erodes and deposits particles, equation (23).
template <int D>
void erode_and_deposit(const Model<D>&, Particles<D>&, Workspace<D>&);

}  // namespace snowshed::methods::mps
