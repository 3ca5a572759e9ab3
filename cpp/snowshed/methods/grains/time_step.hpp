// The longest stable time step.
#pragma once

#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

/// The Courant factor times the smallest sqrt(m / K) of all grains, in translation and in rotation.
/// K is the stiffness of all listed pairs, touching or not, because no other pairs can touch before
/// the next list is made. For rotation it is the largest eigenvalue of the stiffness against
/// turning, sum k (c^2 - c c^T) with the arms c of the contacts, relative to the inertia. The
/// squared frequency of a mode is at most four times the largest K / m (two bodies, each with
/// displacement and rotation), so that factors up to 1 are stable for small displacements.
double max_step(const Model&, const Boundary&, const PairList&, const std::vector<GrainPose>&);

/// A step of at most `max_step` in which nothing moves farther than a tenth of a sphere's diameter.
/// Throws SimulationError if the step would be zero.
double choose_step(const Model&, const State&, double max_step);

}  // namespace snowshed::methods::grains
