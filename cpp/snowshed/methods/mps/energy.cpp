// The balance of energy.
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::mps {

template <int D>
EnergyBalance stored_energy(const Model<D>& model, const Particles<D>& particles) {
  EnergyBalance e;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.is_wall(i)) continue;
    e.kinetic += 0.5 * particles.mass[i] * particles.velocity[i].squaredNorm();
    e.gravitational -= particles.mass[i] * model.gravity.dot(particles.position[i]);
  }
  return e;
}

/// The work of each force in the step is its impulse times the mean of the velocities before and
/// after, so that all works add up to the change of the kinetic energy. Gravity's work differs from
/// the change of potential energy, because particles move with the velocity after the step; this
/// difference is the residual.
template <int D>
void SolverImpl<D>::record_energy(State<D>& next, double dt) const {
  const Particles<D>& after = next.particles;
  EnergyBalance& e = next.energy;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!workspace_.energy.moved[i]) continue;
    const VecD<D>&before = workspace_.before[i], &viscous = workspace_.energy.viscous[i];
    const VecD<D> mean = 0.5 * (before + workspace_.energy.projected[i]);
    const double mass = after.mass[i];
    double friction = 0;
    for (const WallContact<D>* c = workspace_.near.contacts.begin(i);
         c < workspace_.near.contacts.end(i); ++c) {
      const VecD<D> relative = viscous - c->velocity;
      friction += dt * mass * workspace_.wall_friction.drag[workspace_.near.contacts.index_of(c)] *
                  (relative - relative.dot(c->normal) * c->normal).dot(mean);
    }
    e.friction += friction;
    e.plastic -= mass * workspace_.energy.viscous_change[i].dot(mean) + friction;
    e.transfer -= mass * (workspace_.energy.projected[i] - before - dt * model_.gravity -
                          workspace_.energy.viscous_change[i])
                             .dot(mean);
    if (!after.moves(i)) e.sticking += 0.5 * mass * workspace_.energy.projected[i].squaredNorm();
  }
}

template EnergyBalance stored_energy(const Model<2>&, const Particles<2>&);
template EnergyBalance stored_energy(const Model<3>&, const Particles<3>&);
template void SolverImpl<2>::record_energy(State<2>&, double) const;
template void SolverImpl<3>::record_energy(State<3>&, double) const;

}  // namespace snowshed::mps
