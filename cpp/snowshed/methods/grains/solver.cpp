#include "snowshed/methods/grains/solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/grains/check_options.hpp"
#include "snowshed/methods/grains/forces.hpp"
#include "snowshed/methods/grains/pair_tables.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"
#include "snowshed/methods/grains/time_step.hpp"

namespace snowshed::methods::grains {

std::unique_ptr<Solver> make_solver(Options options) {
  check_grains(options);
  return std::make_unique<SolverImpl>(std::move(options));
}

namespace {

/// The state without grains.
State empty_state(const Model& model) {
  State state;
  state.boundary = initial_boundary(model.loaded_sample());
  begin_stage(model.loading, model.loaded_sample(), state.loading, state.boundary);
  state.searched_boundary = state.boundary;
  return state;
}

/// Work of a force in half a step, J, in which the velocity changes.
double work_of(const Vec3& force, const Vec3& before, const Vec3& after, double half_step) {
  return 0.5 * half_step * force.dot(before + after);
}

/// Applies force and torque for half a step; returns the energy that damping takes, J.
double push(const GrainConstants& grain, GrainBody& body, double half_step) {
  const Mat3 rotation = body.orientation.toRotationMatrix();
  const auto spin = [&] { return angular_velocity(rotation, body.spin_momentum, grain.inertia); };
  const Vec3 velocity = body.velocity, turning = spin();
  body.velocity += (half_step / grain.inertial_mass) * body.force;
  body.spin_momentum += half_step * body.torque;
  return -work_of(body.damping, velocity, body.velocity, half_step) -
         work_of(body.spin_damping, turning, spin(), half_step);
}

constexpr std::ptrdiff_t bodies_in_push = 32;

/// Work of the grains on their surroundings in half a step.
double boundary_work(const Boundary& b, double half_step) {
  double power = b.cone_force.dot(b.tip_velocity);
  for (int p = 0; p < 2; ++p) power += b.plate_force[p].dot(b.plate_velocity[p]);
  for (int s = 0; s < 4; ++s) power += (s % 2 == 0 ? -1 : 1) * b.side_force[s] * b.side_velocity[s];
  return -half_step * power;
}

}  // namespace

SolverImpl::SolverImpl(Options o) : model_(std::move(o)), state_(empty_state(model_)) {}

void SolverImpl::require_grains() const {
  if (state_.bodies.empty()) throw SimulationError("there are no grains");
}

std::vector<ParticleBatch> SolverImpl::seed(const StopRequest&) const {
  ParticleBatch batch;
  for (const GrainConstants& grain : model_.grains) {
    batch.positions.push_back(grain.initial_position);
    batch.masses.push_back(model_.settings.density * grain.volume);
  }
  return {std::move(batch)};
}

/// A new sample with the velocities and events of the batches, whose particles must be those of
/// `seed`.
State SolverImpl::with_batches(const std::vector<ParticleBatch>& batches) const {
  State next = empty_state(model_);
  std::size_t i = 0;
  for (const ParticleBatch& batch : batches) {
    check_batch(batch, 1);
    for (std::size_t k = 0; k < batch.positions.size(); ++k, ++i) {
      if (i >= model_.grains.size() || batch.positions[k] != model_.grains[i].initial_position ||
          batch.mass_of(k) != model_.settings.density * model_.grains[i].volume)
        throw InputError("particles", "only the grains of the sample can be added, as they are");
      GrainBody body;
      body.position = model_.grains[i].initial_position;
      body.orientation = model_.grains[i].initial_orientation;
      body.velocity = batch.velocity;
      next.bodies.push_back(body);
      next.events.push_back(std::uint16_t(batch.event));
    }
  }
  if (i != model_.grains.size())
    throw InputError("particles", std::to_string(i) + " grains given; the sample has " +
                                      std::to_string(model_.grains.size()));
  return next;
}

/// Takes over a new sample, with its lists, forces and energies.
void SolverImpl::accept(State next, Workspace work) {
  std::vector<GrainPose> poses = poses_of(next.bodies);
  const std::vector<PairHistory> bonds = initial_bonds(model_, poses, next.boundary);
  PairTables tables = search_pairs(model_, std::move(poses), next.boundary, bonds);
  next.bonds = std::int64_t(bonds.size());
  next.pairs = std::move(tables.pairs);
  next.searched_poses = std::move(tables.poses);
  next.searched_boundary = next.boundary;
  work.groups_by_body = std::move(tables.groups_by_body);
  work.results = std::move(tables.results);
  work.max_step = tables.max_step;
  work.next = next.bodies;
  work.frames.resize(next.bodies.size() + 2);
  work.damped_energy.resize(next.bodies.size());
  evaluate_forces(model_, next, work, 0.0);
  next.dt = choose_step(model_, next, work.max_step);
  double& smallest = next.counters.smallest_dt;
  smallest = smallest > 0 ? std::min(smallest, next.dt) : next.dt;
  std::vector<std::uint32_t> order(next.bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  if (model_.keeps_energy) {
    EnergyBalance before = state_.energy, after = next.energy;
    store_energy(model_, state_, before);
    store_energy(model_, next, after);
    next.energy.added += after.stored() - before.stored();
  }
  state_ = std::move(next);
  workspace_ = std::move(work);
  order_ = std::move(order);
}

void SolverImpl::add(const std::vector<ParticleBatch>& batches, const StopRequest&) {
  soundness_.require();
  if (std::all_of(batches.begin(), batches.end(),
                  [](const ParticleBatch& b) { return b.positions.empty(); }))
    return;
  if (!state_.bodies.empty())
    throw InputError("particles", "the grains of the sample are already there");
  State next = with_batches(batches);
  next.next_id = std::uint32_t(next.bodies.size());
  accept(std::move(next), {});
}

void SolverImpl::replace(const std::vector<ParticleBatch>& batches) {
  soundness_.require();
  State next = with_batches(batches);
  next.time = state_.time;
  next.counters = state_.counters;
  next.pair_searches = state_.pair_searches;
  next.energy = state_.energy;
  next.first_id = state_.next_id;
  next.next_id = state_.next_id + std::uint32_t(next.bodies.size());
  accept(std::move(next), {});
}

void SolverImpl::add_velocity(const std::vector<Vec3>& changes) {
  soundness_.require();
  check_velocity_changes(changes, size());
  double added = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec3& v = state_.bodies[i].velocity;
    added += 0.5 * model_.grains[i].inertial_mass * changes[i].dot(2 * v + changes[i]);
  }
  if (!std::isfinite(added)) throw InputError("velocity changes", "too large");
  for (std::size_t i = 0; i < size(); ++i) state_.bodies[i].velocity += changes[i];
  state_.energy.added += added;
}

/// Applies the forces for half a step and then the motion of a step; the result is in the
/// workspace.
void SolverImpl::drift(double dt) {
  parallel_pieces(std::ptrdiff_t(size()), model_.threads_for(state_.pairs.size()), bodies_in_push,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
                      GrainBody& body = workspace_.next[i] = state_.bodies[i];
                      workspace_.damped_energy[i] = push(model_.grains[i], body, 0.5 * dt);
                      body.position += dt * body.velocity;
                      rotate_freely(body.orientation, body.spin_momentum, model_.grains[i].inertia,
                                    dt);
                    }
                  });
}

/// Throws if a grain has left its surroundings.
void SolverImpl::check_places() const {
  const double farthest = 5e4 * model_.radius + 10 * model_.box.maxCoeff();
  for (std::size_t i = 0; i < workspace_.next.size(); ++i) {
    const GrainBody& body = workspace_.next[i];
    if (!(body.position.cwiseAbs().maxCoeff() < farthest) || !body.orientation.coeffs().allFinite())
      throw SimulationError("grain " + std::to_string(state_.first_id + i) +
                            " is lost: it has left the surroundings of the sample");
  }
}

/// Whether a sphere may have moved more than half the skin since the last search for pairs.
bool SolverImpl::must_relist(const Boundary& moved) const {
  const Boundary& then = state_.searched_boundary;
  if (moved.has_top != then.has_top || moved.has_cone != then.has_cone) return true;
  const double max_travel = 0.5 * skin_per_radius * model_.radius;
  if (!(moved.travel_since(then) < max_travel)) return true;
  for (std::size_t i = 0; i < workspace_.next.size(); ++i) {
    const GrainPose& pose = state_.searched_poses[i];
    const GrainBody& body = workspace_.next[i];
    // The chord of the rotation between both poses: 2 sin(angle / 2).
    const double chord = 2 * (pose.orientation.conjugate() * body.orientation).vec().norm();
    if (!((body.position - pose.position).norm() + chord * model_.grains[i].reach < max_travel))
      return true;
  }
  return false;
}

/// Makes the list for the poses in the workspace. Changes nothing if it throws.
void SolverImpl::relist(const Boundary& moved) {
  PairTables tables =
      search_pairs(model_, poses_of(workspace_.next), moved, state_.pairs.histories());
  double removed = 0;  // J, with the top plate
  if (model_.keeps_energy && moved.has_top != state_.searched_boundary.has_top) {
    EnergyBalance e;
    store_energy(model_, state_, e);
    removed = e.normal + e.shear;
    std::swap(state_.pairs, tables.pairs);
    store_energy(model_, state_, e);
    std::swap(state_.pairs, tables.pairs);
    removed -= e.normal + e.shear;
  }
  state_.energy.added -= removed;
  state_.pairs = std::move(tables.pairs);
  state_.searched_poses = std::move(tables.poses);
  state_.searched_boundary = moved;
  workspace_.groups_by_body = std::move(tables.groups_by_body);
  workspace_.results = std::move(tables.results);
  workspace_.max_step = tables.max_step;
  ++state_.pair_searches;
}

void SolverImpl::step() {
  soundness_.require();
  require_grains();
  const double dt = choose_step(model_, state_, workspace_.max_step);
  Boundary moved = state_.boundary;
  set_velocities(model_.loading, model_.loaded_sample(), state_.loading, dt, moved);
  moved.move(dt);
  drift(dt);
  check_places();
  if (must_relist(moved)) relist(moved);
  end_step(moved, dt);
}

/// Throws only if forces are not finite.
void SolverImpl::end_step(const Boundary& moved, double dt) {
  state_.energy.boundary += boundary_work(moved, 0.5 * dt);  // with the forces before the step
  std::swap(state_.bodies, workspace_.next);
  state_.boundary = moved;
  evaluate_forces(model_, state_, workspace_, dt);
  parallel_pieces(std::ptrdiff_t(size()), model_.threads_for(state_.pairs.size()), bodies_in_push,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
                      workspace_.damped_energy[i] +=
                          push(model_.grains[i], state_.bodies[i], 0.5 * dt);
                  });
  state_.energy.boundary += boundary_work(state_.boundary, 0.5 * dt);
  bool sound = true;
  for (std::size_t i = 0; i < size(); ++i) {
    state_.energy.damping += workspace_.damped_energy[i];
    const GrainBody& body = state_.bodies[i];
    sound = sound && std::isfinite(body.velocity.squaredNorm() + body.spin_momentum.squaredNorm());
  }
  const Boundary& b = state_.boundary;
  LoadingGauge gauge;
  gauge.top_stress = b.plate_force[1].z() / model_.area();
  const double sides[2] = {model_.box.y() * model_.box.z(), model_.box.x() * model_.box.z()};
  gauge.mean_stress = gauge.top_stress / 3;
  for (int s = 0; s < 4; ++s) gauge.mean_stress += b.side_force[s] / sides[s / 2] / 6;
  const std::size_t stage = std::size_t(state_.loading.stage);
  if (stage < model_.loading.size() && model_.loading[stage].kind == LoadingKind::hold)
    gauge.kinetic = kinetic_energy(model_, state_);
  count_step(model_.loading, model_.loaded_sample(), gauge, dt, state_.loading, state_.boundary);
  state_.time += dt;
  state_.dt = dt;
  StepCounters& c = state_.counters;
  ++c.steps;
  c.particle_updates += std::int64_t(size());
  c.smallest_dt = std::min(c.smallest_dt, dt);
  if (sound) return;
  soundness_.lose();
  soundness_.fail("the forces on a grain are not finite");
}

}  // namespace snowshed::methods::grains
