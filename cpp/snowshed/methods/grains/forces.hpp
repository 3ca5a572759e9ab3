// Forces on the grains.
#pragma once

#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

/// Finds the forces on all grains and on their surroundings, advances the contacts by a time step
/// of length dt (s), breaks bonds and counts their energy as lost. The velocities belong to the
/// middle of the step. Throws nothing.
void evaluate_forces(const Model&, State&, Workspace&, double dt);

}  // namespace snowshed::methods::grains
