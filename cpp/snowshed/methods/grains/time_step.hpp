// The longest stable time step.
#pragma once

#include "snowshed/methods/grains/state.hpp"

namespace snowshed::grains {

/// The Courant factor times the least, over grains, of sqrt(m / K) and of the same for rotation.
/// K is the stiffness of all pairs that are listed, whether they touch yet or not: no others can
/// touch before the list is made again. For rotation it is the largest eigenvalue of the stiffness
/// against turning, sum k (c^2 - c c^T) with the arms c of the contacts, relative to the inertia.
/// The pairs' springs can move at most four times as fast as sqrt(K / m) squared (two bodies, each
/// with displacement and rotation), so that factors up to 1 are stable for small displacements.
double max_step(const Model&, const Boundary&, const PairList&, const std::vector<GrainPose>&);

/// A step no longer than that, in which nothing moves farther than a tenth of a sphere's diameter.
/// Throws SimulationError if it would be zero.
double choose_step(const Model&, const State&, double max_step);

}  // namespace snowshed::grains
