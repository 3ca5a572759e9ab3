// The record of the forces on walls.
//
// The corrected gradient does not give pairs of particles equal and opposite forces, so that the
// reaction to a wall's share of the gradient is not the force on the wall. The record begins with
// the pressure at the wall's surface, over the area that each contact stands for, the drag of the
// wall, and the impulses that keep particles out of it. In a flow these pressures and areas have
// errors. The balance of momentum corrects them in each step: whatever changed the momentum of the
// snow, and was neither gravity nor a recorded force, came from the walls that were pressed, along
// their normals.
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "snowshed/methods/mps/elastic_strain.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"
#include "snowshed/methods/mps/wall_areas.hpp"
#include "snowshed/methods/mps/wall_friction.hpp"

namespace snowshed::methods::mps {

/// Records the drag of the walls, which the last solve for the viscosity has used.
template <int D>
void SolverImpl<D>::record_drag(double dt, const Particles<D>& p) {
  const RowLists<WallContact<D>>& contacts = workspace_.near.contacts;
  workspace_.wall_impulse.resize(contacts.all().size());
  for (std::size_t i = 0; i < p.size(); ++i)
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
      const std::size_t k = contacts.index_of(c);
      workspace_.wall_impulse[k] =
          p.moves(i) ? VecD<D>(dt * p.mass[i] * workspace_.wall_friction.drag[k] *
                               sliding_velocity(model_, dt, p.velocity[i], p.elastic_slip[i], *c))
                     : VecD<D>(VecD<D>::Zero());
    }
}

/// Finds the impulses on the walls in a step. Makes new patches, which may fail for lack of memory.
template <int D>
void SolverImpl<D>::find_wall_impulses(double dt, const State<D>& next) {
  const Particles<D>& p = next.particles;
  const RowLists<WallContact<D>>& contacts = workspace_.near.contacts;
  WallImpulses& impulses = workspace_.wall_impulses;
  const std::vector<double> areas =
      contact_areas(model_, workspace_.start.particles, workspace_.near);
  impulses.by_name.assign(forces_->names().size(), ContactImpulse());
  impulses.pushes.clear();
  impulses.moving_mass = 0;
  impulses.momentum = momentum_of(state_.particles).momentum;
  const std::vector<PlacedObstacle> placed = place_obstacles(model_.options.obstacles, state_.time);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!workspace_.start.particles.moves(i)) continue;
    impulses.moving_mass += p.mass[i];
    for (const WallContact<D>* c = contacts.begin(i); c < contacts.end(i); ++c) {
      const std::size_t k = contacts.index_of(c);
      const double push =
          dt * areas[k] * pressure_at_wall(model_, p, i, *c) + p.mass[i] * workspace_.wall_stop[k];
      const VecD<D> impulse = workspace_.wall_impulse[k] - push * c->normal;
      if (impulse.isZero(0)) continue;
      const Vec3 normal = embed(c->normal);
      const Vec3 x = embed(workspace_.start.particles.position[i]) - c->distance * normal;
      impulses.by_name[forces_->name_of(int(c->obstacle))] +=
          ContactImpulse::at(x, normal, embed(impulse));
      const geometry::RigidPose& pose = placed[c->obstacle].pose;
      const Vec3 body_normal = pose.rotation.transpose() * normal;
      impulses.pushes.push_back(
          {forces_->pressures().patch_at(int(c->obstacle), pose.to_body(x), body_normal), push});
    }
  }
}

/// Impulses on pressed walls, along the directions in which they are pressed, that sum up to
/// `impulse` as nearly as these directions allow. Walls share it in proportion to their pushes.
static std::vector<double> shared_by_walls(const std::vector<ContactImpulse>& walls,
                                           const Vec3& impulse) {
  Mat3 sum = Mat3::Zero();
  for (const ContactImpulse& wall : walls) {
    const Vec3 pressed = wall.normal.stableNormalized();
    sum += std::max(wall.push, 0.0) * pressed * pressed.transpose();
  }
  constexpr double min_share = 1e-6;  // directions with a smaller share of the pushes get nothing
  const Eigen::SelfAdjointEigenSolver<Mat3> directions(sum);
  Vec3 solution = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (directions.eigenvalues()[k] > min_share * std::max(sum.trace(), 1e-300)) {
      const Vec3 axis = directions.eigenvectors().col(k);
      solution += impulse.dot(axis) / directions.eigenvalues()[k] * axis;
    }
  constexpr double min_factor = -0.9, max_factor = 10;  // added, as parts of the recorded push
  std::vector<double> shares;
  for (const ContactImpulse& wall : walls)
    shares.push_back(
        std::clamp(wall.normal.stableNormalized().dot(solution), min_factor, max_factor));
  return shares;
}

/// Records the impulses of a step that was taken.
template <int D>
void SolverImpl<D>::record_wall_impulses() noexcept {
  WallImpulses& impulses = workspace_.wall_impulses;
  const Vec3 gravity = impulses.moving_mass * state_.dt * embed(model_.gravity);
  Vec3 lacks = gravity + impulses.momentum - momentum_of(state_.particles).momentum;
  for (const ContactImpulse& on_wall : impulses.by_name) lacks -= on_wall.total();
  const std::vector<double> shares = shared_by_walls(impulses.by_name, lacks);
  for (std::size_t name = 0; name < impulses.by_name.size(); ++name) {
    ContactImpulse& on_wall = impulses.by_name[name];
    if (on_wall.push > 0)
      on_wall.add_at_center(shares[name] * on_wall.push * on_wall.normal.stableNormalized());
    forces_->add(name, on_wall);
    forces_->add_step(name, on_wall.total());
  }
  for (const auto& [patch, push] : impulses.pushes) {
    const int obstacle = forces_->pressures().patches()[std::size_t(patch)].obstacle();
    forces_->pressures().push(patch, (1 + shares[forces_->name_of(obstacle)]) * push);
  }
  forces_->end_interval(state_.dt, gravity);
  forces_->end_step(state_.time, state_.dt);
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

template <int D>
RestingForces SolverImpl<D>::resting_forces(bool) const {
  RestingForces resting;
  for (const ObstacleForce& force : forces_->forces()) resting.forces.push_back({force.recent, {}});
  for (const Patch& patch : forces_->pressures().patches()) {
    resting.pressures.push_back(forces_->pressures().last_pressure(patch));
    resting.forces[forces_->name_of(patch.obstacle())].pressed.add(patch, resting.pressures.back());
  }
  return resting;
}

template Momentum momentum_of(const Particles<2>&);
template Momentum momentum_of(const Particles<3>&);
template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
