// The viscous force as the divergence of a symmetric stress.
#pragma once

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// Finds the weights of pairs in the viscous force for the present positions.
template <int D>
void find_stress_weights(const Model<D>&, const Particles<D>&, Workspace<D>&);

/// Finds the levers of pairs, from which the turns of particles follow (see kernels/stress.hpp).
template <int D>
void find_levers(const Model<D>&, Workspace<D>&);

/// q = own_block p minus the change of velocity by the stress of the velocities p. With the
/// deviations v' = v - W r of a pair's difference v from the rotation W of the snow around it, the
/// force is that of the energy sum of coupling |v' + E r|^2, here without the rates E of the
/// elastic strains. In a linear flow this is the energy of the stress 2 eta D. A rotation costs
/// nothing, and both momenta are conserved (ours).
template <int D>
void apply_symmetric_stress(const Model<D>&, Workspace<D>&, const double* p, double* q);

/// Adds the share of the rates E in this force, `rates.elastic`, to the right-hand side.
template <int D>
void add_elastic_force(const Model<D>&, Workspace<D>&);

}  // namespace snowshed::methods::mps
