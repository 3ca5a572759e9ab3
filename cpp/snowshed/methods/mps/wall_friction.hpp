// Friction of walls on the snow beside them, and the stress by which walls hold pressed snow.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// The pressure at a wall's surface, continued from the particle beside it, together with the
/// `reaction` by which the wall holds the snow, Pa.
template <int D>
double pressure_at_wall(const Model<D>& model, const Particles<D>& p, std::size_t i,
                        const WallContact<D>& c, double reaction = 0) {
  return std::max(
      0.0, p.pressure[i] + reaction -
               model.settings().density * c.distance * p.pressure_acceleration[i].dot(c.normal));
}

/// Computes the share of the wall's shear stress that each contact carries. The particles that
/// touch the obstacle around a wall particle divide its friction among them.
template <int D>
void compute_wall_contact_fractions(const Model<D>&, const Particles<D>&, Workspace<D>&);

/// A wall's action on a particle in a step of the viscous equation: the matrix and the right-hand
/// side of `matrix u = right_side`, with the particle's own u = velocity.
template <int D>
struct WallAction {
  Eigen::Matrix<double, D, D> matrix;  // 1
  VecD<D> right_side;                  // m/s
};

/// Finds the drag of the walls on particle i at its present velocity, and adds their action.
/// `start` has the velocities before viscosity acts.
template <int D>
void add_wall_action(const Model<D>&, double dt, const AlignedVector<VecD<D>>& start,
                     const Particles<D>&, std::size_t i, Workspace<D>&, WallAction<D>&);

/// Finds the pressures by which walls hold elastic snow, which the pressure equation does not know
/// of. They enter the friction of the next iteration.
template <int D>
void find_wall_reactions(const Model<D>&, double dt, const AlignedVector<VecD<D>>& start,
                         const Particles<D>&, Workspace<D>&);

}  // namespace snowshed::methods::mps
