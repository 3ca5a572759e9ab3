// The stable time step of explicit MPM.
#pragma once

#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::mpm {

/// max over positions of sum_i (dN_i)^2 / N_i for a B-spline, per cell squared.
constexpr double stability_number(Basis basis) { return basis == Basis::quadratic ? 6.0 : 3.2; }

/// The number S that makes dt^2 < 2 rho_0 dx^2/(S (d lambda + 2 mu)) the limit of a transfer.
///
/// With R from the grid's velocities to the particles' and R* back, a mode u of the grid is stable
/// if dt^2 |strain rate of u|^2 <= 2 |u|^2 + 2 |R u|^2, in the norms of the elastic and the kinetic
/// energy. All three are sums over particles, so that a lone particle is the worst case again.
/// FLIP's R u has no part along the gradient. APIC's has one, along the arm of the nodes, where
/// sum_i (dN_i)^2/N_i is the inverse of its inertia; only the rest is damped. Affine FLIP hands
/// back the same affine velocity, and a lone particle's velocity takes no part in its strain.
constexpr double transfer_stability_number(Transfer transfer, Basis basis) {
  const double all = stability_number(basis);
  return transfer == Transfer::flip ? all : all - apic_inverse_inertia(basis) / 2;
}

/// Limit of the elastic time step, s.
///
/// With the mass lumped, each node's mass is the sum of its particles' m N_i, and the stiffness
/// is a sum over particles too; the highest frequency of the whole is then at most the highest of
/// one particle alone on the grid: omega^2 = stability_number (d lambda + 2 mu)/(rho_0 dx^2).
/// Symplectic Euler alone would be stable for dt < 2/omega. But FLIP hands back only velocities,
/// not their gradient, so that a lone particle's strain obeys e <- (1 - omega^2 dt^2) e, which
/// needs dt < sqrt(2)/omega; that is the limit taken. APIC hands back a part of the gradient, see
/// `transfer_stability_number`. The density is the initial one: a particle's force is its initial
/// volume times the Kirchhoff stress, so that compaction, which raises density and stiffness alike,
/// leaves the limit as it is.
double elastic_time_step(double youngs_modulus, double poissons_ratio, double density,
                         int dimension, double dx, Transfer transfer, Basis basis);

/// The time step to take: the elastic limit shortened so that the fastest particle moves no more
/// than half a cell. `factor` in (0, 1].
double next_time_step(double elastic_limit, double speed, double dx, double factor);

}  // namespace snowshed::mpm
