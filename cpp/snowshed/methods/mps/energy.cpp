#include "snowshed/methods/mps/energy.hpp"

#include "snowshed/methods/mps/elastic_strain.hpp"

namespace snowshed::methods::mps {

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

template <int D>
void EnergyRecorder<D>::begin_step(const Particles<D>& particles) {
  if (!active_) return;
  moved_.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) moved_[i] = particles.moves(i);
}

template <int D>
void EnergyRecorder<D>::after_viscosity(const AlignedVector<VecD<D>>& before,
                                        const Particles<D>& particles) {
  if (!active_) return;
  viscous_ = particles.velocity;
  viscous_change_.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    viscous_change_[i] = particles.velocity[i] - before[i];
}

template <int D>
void EnergyRecorder<D>::after_forces(const Particles<D>& particles) {
  if (active_) final_ = particles.velocity;
}

/// The work of each force is its impulse times the mean of the velocities before and after the
/// step, so that all works add up to the change of the kinetic energy. Gravity's work differs from
/// the change of potential energy, because particles move with the velocity after the step; this
/// difference is the residual.
template <int D>
void EnergyRecorder<D>::end_step(const Model<D>& model, const Workspace<D>& work, double dt,
                                 State<D>& next) const {
  if (!active_) return;
  const Particles<D>& after = next.particles;
  EnergyBalance& e = next.energy;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!moved_[i]) continue;
    const VecD<D>& before = work.before[i];
    const VecD<D> mean = 0.5 * (before + final_[i]);
    const double mass = after.mass[i];
    double friction = 0;
    for (const WallContact<D>* c = work.near.contacts.begin(i); c < work.near.contacts.end(i);
         ++c) {
      friction += dt * mass * work.wall_friction.drag[work.near.contacts.index_of(c)] *
                  sliding_velocity(model, dt, viscous_[i], work.start.particles.elastic_slip[i], *c)
                      .dot(mean);
    }
    e.friction += friction;
    e.plastic -= mass * viscous_change_[i].dot(mean) + friction;
    e.transfer -= mass * (final_[i] - before - dt * model.gravity - viscous_change_[i]).dot(mean);
    if (!after.moves(i)) e.sticking += 0.5 * mass * final_[i].squaredNorm();
  }
}

template EnergyBalance stored_energy(const Model<2>&, const Particles<2>&);
template EnergyBalance stored_energy(const Model<3>&, const Particles<3>&);
template class EnergyRecorder<2>;
template class EnergyRecorder<3>;

}  // namespace snowshed::methods::mps
