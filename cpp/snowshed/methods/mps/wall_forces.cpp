// The record of the forces on walls.
//
// The corrected gradient does not give pairs of particles equal and opposite forces, so that the
// sum of the forces on the snow is not the force of the walls. The force on a wall is therefore
// that of the pressure at its surface, over the area that each contact stands for, with the drag
// of the wall and the impulses that keep particles out of it. The balance of momentum shows what
// the scheme adds by itself.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::methods::mps {

/// The pressure at a wall's surface, continued from the particle beside it, Pa.
template <int D>
static double pressure_at_wall(const Model<D>& model, const Particles<D>& p, std::size_t i,
                               const WallContact<D>& c) {
  return std::max(0.0, p.pressure[i] - model.settings().density * c.distance *
                                           p.pressure_acceleration[i].dot(c.normal));
}

/// Records the drag of the walls, which the last solve for the viscosity has used.
template <int D>
void SolverImpl<D>::record_drag(double dt, const Particles<D>& p) {
  const RowLists<WallContact<D>>& contacts = workspace_.near.contacts;
  workspace_.wall_impulse.resize(contacts.all().size());
  for (std::size_t i = 0; i < p.size(); ++i)
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
      const std::size_t k = contacts.index_of(c);
      const VecD<D> relative = p.velocity[i] - c->velocity;
      workspace_.wall_impulse[k] = p.moves(i)
                                       ? VecD<D>(dt * p.mass[i] * workspace_.wall_friction.drag[k] *
                                                 (relative - relative.dot(c->normal) * c->normal))
                                       : VecD<D>(VecD<D>::Zero());
    }
}

/// Finds the impulses on the walls in a step. Makes new patches, which may fail for lack of memory.
template <int D>
void SolverImpl<D>::find_wall_impulses(double dt, const State<D>& next) {
  const Particles<D>& p = next.particles;
  const RowLists<WallContact<D>>& contacts = workspace_.near.contacts;
  WallImpulses& found = workspace_.wall_impulses;
  found.by_name.assign(forces_->names().size(), ContactImpulse());
  found.pushes.clear();
  found.moving_mass = 0;
  const std::vector<PlacedObstacle> placed =
      place_obstacles(model_.options.obstacles, state_.time);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!workspace_.start.particles.moves(i)) continue;
    found.moving_mass += p.mass[i];
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
      const std::size_t k = contacts.index_of(c);
      const double l0 = model_.settings().spacing;
      const double area = share_of_wall(c->distance / l0, model_.second_layer) * p.mass[i] /
                          (model_.settings().density * l0);
      const double push = dt * area * pressure_at_wall(model_, p, i, *c) +
                          p.mass[i] * workspace_.wall_stop[k];
      const VecD<D> impulse = workspace_.wall_impulse[k] - push * c->normal;
      if (impulse.isZero(0)) continue;
      const Vec3 normal = embed(c->normal);
      const Vec3 x = embed(workspace_.start.particles.position[i]) - c->distance * normal;
      found.by_name[forces_->name_of(int(c->obstacle))] +=
          ContactImpulse::at(x, normal, embed(impulse));
      const geometry::RigidPose& pose = placed[c->obstacle].pose;
      const Vec3 body_normal = pose.rotation.transpose() * normal;
      found.pushes.push_back(
          {forces_->pressures().patch_at(int(c->obstacle), pose.to_body(x), body_normal), push});
    }
  }
}

/// Records the impulses of a step that was taken.
template <int D>
void SolverImpl<D>::record_wall_impulses() noexcept {
  const WallImpulses& found = workspace_.wall_impulses;
  for (std::size_t name = 0; name < found.by_name.size(); ++name)
    forces_->add(name, found.by_name[name]);
  for (const auto& [patch, push] : found.pushes) forces_->pressures().push(patch, push);
  forces_->end_step(state_.time, state_.dt,
                    found.moving_mass * state_.dt * embed(model_.gravity));
  if (forces_->pressures().half_is_over(state_.time)) forces_->pressures().end_half(state_.time);
}

template <int D>
Momentum momentum_of(const Particles<D>& p) {
  Momentum m;
  for (std::size_t i = 0; i < p.size(); ++i) {
    m.mass += p.mass[i];
    m.momentum += p.mass[i] * embed(p.velocity[i]);
  }
  return m;
}

template <int D>
void SolverImpl<D>::end_balance() noexcept {
  if (forces_) forces_->leave_unbalanced(forces_->end_balance(momentum_of(state_.particles)));
}

template <int D>
void SolverImpl<D>::begin_force_event() noexcept {
  if (forces_) forces_->begin_event(state_.time);
}

template <int D>
std::vector<ForceSample> SolverImpl<D>::sample_forces(double duration) {
  end_balance();
  return forces_->sample(duration);
}

/// Recent means. The pressures at walls are by up to a per cent too high on a coarse spacing; at
/// rest they are scaled so that the walls carry the weight.
template <int D>
RestingForces SolverImpl<D>::resting_forces(bool at_rest) const {
  double carried = 0, weight = 0;
  for (const ObstacleForce& force : forces_->forces())
    carried += force.recent.total().dot(embed(model_.gravity));
  for (std::size_t i = 0; i < size(); ++i)
    weight += state_.particles.mass[i] * model_.gravity.squaredNorm();
  constexpr double max_correction = 0.1;  // more would hide a fault
  const bool is_near = std::abs(weight - carried) < max_correction * weight;
  const double factor = at_rest && is_near ? weight / carried : 1.0;
  RestingForces resting;
  for (const ObstacleForce& force : forces_->forces())
    resting.forces.push_back({factor * force.recent, {}});
  for (const Patch& patch : forces_->pressures().patches()) {
    resting.pressures.push_back(factor * forces_->pressures().last_pressure(patch));
    resting.forces[forces_->name_of(patch.obstacle())].pressed.add(patch,
                                                                   resting.pressures.back());
  }
  return resting;
}

template Momentum momentum_of(const Particles<2>&);
template Momentum momentum_of(const Particles<3>&);
template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
