// The elastic strain of snow, by which it remembers its shear stress until it yields (ours).
//
// Snow with the yield stress tau0 has the shear modulus tau0 over `yield_strain`. The elastic
// strain is a symmetric matrix per particle; its shear strain, sqrt(2 e:e), is at most the yield
// strain. A step adds the strain rate times the step, and then reduces the strain to the yield
// strain. The stress of a pair of particles is that of the strain after the step, which follows
// from the velocities after the step and the mean of both strains before it.
//
// The trace belongs to the strain, because pairs resist changes of volume, too. The pressure does
// not bear the small errors of forces at a free surface; without the trace a free corner crept by
// 1 mm/s.
#pragma once

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// The velocity at which a particle slides along a wall, m/s. Elastic snow adds its elastic slip
/// over the step.
template <int D>
VecD<D> sliding_velocity(const Model<D>& model, double dt, const VecD<D>& velocity,
                         const VecD<D>& elastic_slip, const WallContact<D>& c) {
  VecD<D> relative = velocity - c.velocity;
  if (model.is_elastic()) relative += elastic_slip / dt;
  return relative - relative.dot(c.normal) * c.normal;
}

/// The strain after a step with a velocity gradient: it grows by the strain rate, at most to the
/// yield strain, and turns with the snow (Cayley's form of a rotation).
template <int D>
Eigen::Matrix<double, D, D> strain_after(const Eigen::Matrix<double, D, D>& strain,
                                         const Eigen::Matrix<double, D, D>& gradient, double dt,
                                         double yield_strain);

/// Finds the elastic strains before the step over the length of the step, `rates.elastic`, 1/s.
template <int D>
void find_elastic_rates(const Model<D>&, double dt, const Particles<D>&, Workspace<D>&);

/// Computes the elastic strains after a step of dt from the velocities. They turn with the snow.
template <int D>
void update_elastic_strains(const Model<D>&, double dt, Particles<D>&, Workspace<D>&);

}  // namespace snowshed::methods::mps
