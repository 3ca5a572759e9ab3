// The stable time step of explicit MPM.
#pragma once

#include <string>

#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/step_length.hpp"

namespace snowshed::methods::mpm {

/// max over positions of sum_i (dN_i)^2 / N_i for a B-spline, per cell squared.
constexpr double stability_number(Basis basis) { return basis == Basis::quadratic ? 6.0 : 3.2; }

/// Returns the stability number S of a transfer scheme: steps are stable for dt^2 < 2 rho_0 dx^2/(S
/// (d lambda + 2 mu)).
///
/// Let R transfer velocities from the grid to the particles, and R* back. A mode u of the grid is
/// stable if dt^2 |strain rate of u|^2 <= 2 |u|^2 + 2 |R u|^2, in the norms of the elastic and the
/// kinetic energy. All three terms are sums over particles, so that a lone particle is the worst
/// case here, too. FLIP's R u has no part along the gradient. APIC's R u has one, along the arm of
/// the nodes, where sum_i (dN_i)^2/N_i is the inverse of its inertia; only the rest is damped.
/// Affine FLIP returns the same affine velocity, and a lone particle's velocity takes no part in
/// its strain.
constexpr double transfer_stability_number(Transfer transfer, Basis basis) {
  const double all = stability_number(basis);
  return transfer == Transfer::flip ? all : all - apic_inverse_inertia(basis) / 2;
}

/// Limit of the elastic time step, s.
///
/// With lumped mass, the mass of a node is the sum of m N_i over its particles. The stiffness is a
/// sum over particles, too. The highest frequency of all snow is therefore at most that of a lone
/// particle on the grid: omega^2 = stability_number (d lambda + 2 mu)/(rho_0 dx^2). Symplectic
/// Euler alone would be stable for dt < 2/omega. But FLIP returns only velocities to the grid, not
/// their gradient. The strain of a lone particle then obeys e <- (1 - omega^2 dt^2) e, which needs
/// dt < sqrt(2)/omega. This is the limit for FLIP. APIC returns a part of the gradient, see
/// `transfer_stability_number`. The density is the initial one, because the force of a particle is
/// its initial volume times the Kirchhoff stress. Compaction raises density and stiffness alike, so
/// it does not change the limit.
double elastic_time_step(double youngs_modulus, double poissons_ratio, double density,
                         int dimension, double dx, Transfer transfer, Basis basis);

/// The message for a time step that fell to dt (s) at a time (s), because of a strain.
std::string describe_stuck(double dt, double time, double strain, double limit);

}  // namespace snowshed::methods::mpm
