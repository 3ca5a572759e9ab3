#include "snowshed/methods/mpm/solver.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"
#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed::methods::mpm {
template <class T, int D>
SolverImpl<T, D>::SolverImpl(Options options)
    : model_(std::move(options)),
      state_(model_),
      workspace_(model_.options.settings, model_.boundary.laws().size()) {}

template <class T, int D>
StepParameters<T> SolverImpl<T, D>::parameters(double dt) const {
  const Settings& n = model_.options.settings;
  return {T(dt),
          T(n.dx),
          T(model_.options.gravity),
          T(n.flip_share(dt)),
          T(std::min(1.0, dt / state_.friction_memory)),
          T(dt / (friction_reach * n.dx)),
          T(n.overstress_share(dt)),
          model_.constants.data(),
          workspace_.friction_shares.shares.data(),
          false,
          reinterpret_cast<MaterialLaw<T>>(model_.options.laws.material),
          reinterpret_cast<ConstitutiveLaw<T>>(model_.options.laws.constitutive),
          model_.options.laws.own_numbers};
}

template <class T, int D>
void SolverImpl<T, D>::step() {
  soundness_.require();
  if (size() == 0) throw SimulationError("there is no snow to simulate");
  const StepTotals before = state_.totals;
  const bool tiles_were_valid = workspace_.tiles_valid;
  double dt;
  try {
    dt = try_step();
  } catch (...) {
    state_.totals = before;
    workspace_.tiles_valid = tiles_were_valid;
    throw;
  }
  record_step(dt);
  check_particles();
  update_sleep();
}

/// The parts of a step that can fail (time step too long, no memory). Particles move last.
template <class T, int D>
double SolverImpl<T, D>::try_step() {
  if (!workspace_.tiles_valid) {
    sort();
    scatter();
  }
  const Settings& n = model_.options.settings;
  double dt = next_time_step(state_.elastic_limit, state_.totals.speed, n.dx, n.courant_factor);
  gather_and_update(dt);
  try {
    dt = shorten_to_limits(dt);
    g2p2g(dt);
  } catch (...) {
    for (std::int32_t g : state_.sleep.active()) state_.contacts.reject(g);
    for (EventContact<T>& c : state_.event_contacts) c.next_impulse = c.impulse;
    throw;
  }
  return dt;
}

/// Records a step after the particles have moved.
template <class T, int D>
void SolverImpl<T, D>::record_step(double dt) noexcept {
  StepTotals& p = state_.totals;
  double speed_squared = 0;
  for (std::int32_t b : state_.sleep.awake()) {
    const BlockStats& s = workspace_.grid.block_stats[b];
    speed_squared = std::max(speed_squared, s.max_speed_squared);
    if (s.escaped) workspace_.tiles_valid = false;
  }
  p.speed = std::sqrt(speed_squared);
  p.dt = dt;
  if (model_.options.energy) update_energy_balance();
  record_damping(dt);
  p.time += dt;
  record_forces(dt);
  ++p.counters.steps;
  p.counters.particle_updates += state_.sleep.awake_particles();
  p.slept_updates += std::int64_t(size()) - state_.sleep.awake_particles();
  p.counters.smallest_dt = std::min(p.counters.smallest_dt, dt);
  if (++workspace_.since_sort >= workspace_.until_sort) workspace_.tiles_valid = false;
}

template <class T, int D>
void SolverImpl<T, D>::sort() {
  state_.arrange(model_, blocks_of_particles(state_.layout));
  workspace_.since_sort = 0;
  workspace_.until_sort = steps_until_sort(size(), state_.contacts.size());
  ++state_.totals.sorts;
}

template <class T, int D>
void SolverImpl<T, D>::scatter() {
  workspace_.grid.resize(state_.layout);
  if (workspace_.average) workspace_.average->connect(state_.layout);
  if (model_.touches()) workspace_.touch.forget(model_, state_);
  workspace_.event_contacts.forget(model_, state_, threads());
  const ParticleView<T> view = state_.particles.view();
  const StepParameters<T> step = parameters(state_.totals.dt);
  const std::ptrdiff_t n = std::ptrdiff_t(state_.layout.particle_blocks.size());
  parallel_for_dynamic(n, threads(), 1, [&](std::ptrdiff_t b) { scatter_block(step, view, b); });
  rest_idle_nodes();
  if (state_.forces) hold_sleeping_forces();
  workspace_.tiles_valid = true;
}

template <class T, int D>
void SolverImpl<T, D>::scatter_block(const StepParameters<T>& step, const ParticleView<T>& view,
                                     std::ptrdiff_t b) {
  workspace_.grid.block_stats[b] = {};
  model_.kernels.scatter(step, view, state_.layout.first[b],
                         state_.layout.first[b + 1] - state_.layout.first[b],
                         workspace_.grid.tile(b), workspace_.grid.block_stats[b]);
}

/// First half of a step: the node sums and, in the same loop, the node velocities for a step of dt.
template <class T, int D>
void SolverImpl<T, D>::gather_and_update(double dt) {
  state_.follow_obstacles(model_, threads());
  if (model_.touches())
    workspace_.touch.update(model_, state_, state_.totals.speed * state_.totals.dt, threads());
  if (model_.boundary.any_slip()) state_.contacts.find_friction_shares(workspace_.friction_shares);
  StepParameters<T> step = parameters(dt);
  step.holds_last = true;
  const std::vector<std::int32_t>& active = state_.sleep.active();
  parallel_for_dynamic(std::ptrdiff_t(active.size()), threads(), 8, [&](std::ptrdiff_t i) {
    const std::int32_t g = active[i];
    state_.contacts.commit(g);
    gather(g);
    if (!has_overlap(g)) update_block(step, g);
  });
  if (state_.layout.has_overlap.empty()) return;
  for (EventContact<T>& c : state_.event_contacts) c.impulse = c.next_impulse;
  workspace_.event_contacts.update(model_, state_, workspace_.grid, threads());
  update_overlaps(step);
}

/// Sums the tiles of the particle blocks around a grid block.
template <class T, int D>
void SolverImpl<T, D>::gather(std::int32_t g) {
  const T* tiles[neighbour_count<D>];
  const bool touched = workspace_.grid.tiles_reaching(state_.layout, g, tiles);
  workspace_.grid.touched[g] = touched;
  if (touched) model_.kernels.gather(tiles, workspace_.grid.sum(g));
}

template <class T, int D>
void SolverImpl<T, D>::update(double dt) {
  const StepParameters<T> step = parameters(dt);
  const std::vector<std::int32_t>& active = state_.sleep.active();
  parallel_for_dynamic(std::ptrdiff_t(active.size()), threads(), 8, [&](std::ptrdiff_t i) {
    if (!has_overlap(active[i])) update_block(step, active[i]);
  });
  if (!state_.layout.has_overlap.empty()) update_overlaps(step);
}

/// In an overlap, the fields act on each other after the forces and before the contact with
/// obstacles.
template <class T, int D>
void SolverImpl<T, D>::update_overlaps(const StepParameters<T>& step) {
  parallel_for_dynamic(workspace_.event_contacts.overlap_count(state_.layout), threads(), 2,
                       [&](std::ptrdiff_t overlap) { update_overlap(step, overlap); });
}

template <class T, int D>
void SolverImpl<T, D>::update_overlap(const StepParameters<T>& step, std::ptrdiff_t overlap) {
  const auto begin = state_.layout.overlap_blocks.begin() + state_.layout.overlap_first[overlap];
  const auto end = state_.layout.overlap_blocks.begin() + state_.layout.overlap_first[overlap + 1];
  if (!state_.sleep.is_active(*begin)) return;
  if (!workspace_.event_contacts.any(overlap)) {
    for (auto g = begin; g != end; ++g) update_block(step, *g);
    return;
  }
  for (auto g = begin; g != end; ++g) {
    workspace_.grid.node_stats[*g] = {};
    if (workspace_.grid.touched[*g]) {
      model_.kernels.update_free(step, workspace_.grid.sum(*g), workspace_.grid.velocity(*g));
      if (model_.options.laws.body_force) add_body_force(step, *g);
    } else {
      clear_block(step, *g);
    }
  }
  workspace_.event_contacts.exchange(model_, step, state_, workspace_.grid, overlap);
  for (auto g = begin; g != end; ++g)
    if (workspace_.grid.touched[*g]) finish_block(step, *g);
}

/// Contact with obstacles, after the forces.
template <class T, int D>
void SolverImpl<T, D>::finish_block(const StepParameters<T>& step, std::ptrdiff_t g) {
  model_.kernels.finish(step, workspace_.grid.sum(g), workspace_.grid.velocity(g),
                        state_.contacts.of_block(g), state_.contacts.forces_of(g),
                        state_.contacts.count(g), model_.boundary.laws().data(),
                        workspace_.grid.node_stats[g]);
}

/// Adds the acceleration by the user's body force to the velocities of a block's nodes.
template <class T, int D>
void SolverImpl<T, D>::add_body_force(const StepParameters<T>& step, std::ptrdiff_t g) {
  constexpr int n = block_nodes<D>;
  double x[3][n] = {}, a[3][n] = {};
  const BlockCoord<D> block = block_coord<D>(state_.layout.grid_blocks[g]);
  for (int k = 0; k < n; ++k) {
    const Vec3 at = embed(node_position<D>(block, k, model_.options.settings.dx));
    for (int d = 0; d < 3; ++d) x[d][k] = at[d];
  }
  model_.options.laws.body_force(n, x[0], x[1], x[2], time(), a[0], a[1], a[2]);
  const T* sums = workspace_.grid.sum(g);
  T* velocities = workspace_.grid.velocity(g);
  for (int k = 0; k < n; ++k) {
    if (!(sums[k * node_values] > min_node_mass<T>)) continue;
    const VecD<D> change = double(step.dt) * section<D>(Vec3(a[0][k], a[1][k], a[2][k]));
    for (int d = 0; d < D; ++d)
      for (const int half : {0, 4}) velocities[k * node_values + half + d] += T(change[d]);
  }
}

template <class T, int D>
void SolverImpl<T, D>::update_block(const StepParameters<T>& step, std::ptrdiff_t g) {
  workspace_.grid.node_stats[g] = {};
  if (!workspace_.grid.touched[g]) return clear_block(step, g);
  if (model_.options.laws.body_force) {
    model_.kernels.update_free(step, workspace_.grid.sum(g), workspace_.grid.velocity(g));
    add_body_force(step, g);
    return finish_block(step, g);
  }
  model_.kernels.update(step, workspace_.grid.sum(g), workspace_.grid.velocity(g),
                        state_.contacts.of_block(g), state_.contacts.forces_of(g),
                        state_.contacts.count(g), model_.boundary.laws().data(),
                        workspace_.grid.node_stats[g]);
}

/// No particle touches these nodes, so their velocities are not used.
template <class T, int D>
void SolverImpl<T, D>::clear_block(const StepParameters<T>& step, std::ptrdiff_t g) {
  std::fill_n(workspace_.grid.node_stats[g].low, D, geometry::infinity);
  std::fill_n(workspace_.grid.node_stats[g].high, D, -geometry::infinity);
  Contact<T>* contacts = state_.contacts.of_block(g);
  for (int c = 0; c < state_.contacts.count(g); ++c) contacts[c].next_normal_impulse = 0;
  if (ContactForce<T>* forces = state_.contacts.forces_of(g))
    for (int c = 0; c < state_.contacts.count(g); ++c) {
      if (step.holds_last) sum_impulse(forces[c]);
      std::fill_n(forces[c].impulse, 4, T(0));
    }
}

/// Shortens a step that would strain a particle beyond the limit. The grid's sums do not depend on
/// dt, so only the node velocities are computed again.
template <class T, int D>
double SolverImpl<T, D>::shorten_to_limits(double dt) {
  const double limit = model_.options.settings.strain_limit;
  while (true) {
    const double strain = largest_strain() * dt;
    if (strain <= limit) return dt;
    ++state_.totals.counters.rejected;
    dt = shortened_time_step(dt, strain, limit);
    if (!(dt > min_step_share * state_.elastic_limit))  // also if the strain is not finite
      throw SimulationError(describe_stuck(dt, time(), strain, limit));
    update(dt);
  }
}

/// Returns the largest velocity gradient (1/s) that a particle will see, or a bound of it.
/// Derivatives of B-splines average the differences between nodes, so the range of the nodes'
/// velocities bounds the gradient. The range over all nodes is tried first, then the range around
/// each block. The particles themselves are examined only if these bounds are too large.
template <class T, int D>
double SolverImpl<T, D>::largest_strain() {
  const double dx = model_.options.settings.dx;
  const double rate_limit =
      model_.options.settings.strain_limit /
      next_time_step(state_.elastic_limit, 0.0, dx, model_.options.settings.courant_factor);
  const auto bound_over = [&](const auto& grid_blocks) {
    VecD<D> low = VecD<D>::Constant(geometry::infinity), high = -low;
    for (std::int32_t g : grid_blocks) {
      const NodeStats& s = workspace_.grid.node_stats[g];
      for (int d = 0; d < D; ++d) {
        low[d] = std::min(low[d], s.low[d]);
        high[d] = std::max(high[d], s.high[d]);
      }
    }
    return std::max(0.0, (high - low).maxCoeff() / dx);  // no snow: negative
  };
  const double overall = bound_over(state_.sleep.active());
  if (overall <= rate_limit) return overall;

  const StepParameters<T> unit = parameters(1.0);
  const ParticleView<T> view = state_.particles.view();
  const std::vector<std::int32_t>& awake = state_.sleep.awake();
  workspace_.block_strain.resize(awake.size());
  parallel_for_dynamic(std::ptrdiff_t(awake.size()), threads(), 64, [&](std::ptrdiff_t i) {
    const std::int32_t b = awake[i];
    double bound = bound_over(state_.layout.around_particles[b]);
    if (!(bound <= rate_limit)) {
      const double strain = probe(unit, view, b).strain;
      bound = std::isfinite(strain) ? strain : geometry::infinity;
    }
    workspace_.block_strain[i] = bound;
  });
  return *std::max_element(workspace_.block_strain.begin(), workspace_.block_strain.end());
}

template <class T, int D>
void SolverImpl<T, D>::velocities_around(std::int32_t b,
                                         const T* (&velocities)[neighbour_count<D>]) {
  for (int k = 0; k < neighbour_count<D>; ++k)
    velocities[k] = workspace_.grid.velocity(state_.layout.around_particles[b][k]);
}

template <class T, int D>
void SolverImpl<T, D>::g2p2g(double dt) {
  const StepParameters<T> step = parameters(dt);
  const ParticleView<T> view = state_.particles.view();
  const std::vector<std::int32_t>& awake = state_.sleep.awake();
  const bool damps = damps_next();
  if (damps) average_velocities(dt);
  parallel_for_dynamic(std::ptrdiff_t(awake.size()), threads(), 1, [&](std::ptrdiff_t i) {
    const std::int32_t b = awake[i];
    const T* velocities[neighbour_count<D>];
    velocities_around(b, velocities);
    workspace_.grid.block_stats[b] = BlockStats::reaching(workspace_.grid.block_stats[b].reach);
    model_.kernels.g2p2g(step, view, state_.layout.first[b],
                         state_.layout.first[b + 1] - state_.layout.first[b], velocities,
                         damps ? &workspace_.average->tile(b) : nullptr, workspace_.grid.tile(b),
                         workspace_.grid.block_stats[b]);
  });
}

template <class T, int D>
bool SolverImpl<T, D>::damps_next() const {
  return workspace_.average && damps_after(state_.totals.undamped_steps);
}

/// Averages the particles' velocities. The step of dt that follows damps them, and makes up for the
/// steps since the last damping.
template <class T, int D>
void SolverImpl<T, D>::average_velocities(double dt) noexcept {
  const double rate = model_.options.settings.damping_rate.value_or(0.0);
  const double share = damped_share(rate, state_.totals.undamped_time + dt);
  workspace_.average->update(model_.kernels, state_.particles.view(), state_.layout, state_.sleep,
                             share, threads());
}

template <class T, int D>
void SolverImpl<T, D>::record_damping(double dt) noexcept {
  if (!workspace_.average) return;
  count_undamped(state_.totals.undamped_steps, state_.totals.undamped_time, dt);
}

/// Throws if a particle is not sound any more. The step cannot be taken back: the particles have
/// moved, and a copy of them in each step would cost more than it is worth.
template <class T, int D>
void SolverImpl<T, D>::check_particles() {
  for (std::int32_t b : state_.sleep.awake()) {
    if (workspace_.grid.block_stats[b].unsound < 0) continue;
    soundness_.lose();  // also if the memory for the message is missing
    const BlockStats& s = workspace_.grid.block_stats[b];
    soundness_.fail(describe_unsound(b, std::size_t(s.unsound), s.elastic_strain));
  }
}

template <class T, int D>
void SolverImpl<T, D>::fail_at(std::int32_t particle) {
  soundness_.lose();
  const std::vector<std::int32_t>& first = state_.layout.first;
  const auto next = std::upper_bound(first.begin(), first.end(), particle);
  const std::size_t i = std::size_t(particle);
  soundness_.fail(describe_unsound(std::int32_t(next - first.begin()) - 1, i,
                                   std::sqrt(material::norm_squared(elastic_strain(i)))));
}

template <class T, int D>
std::string SolverImpl<T, D>::describe_unsound(std::int32_t b, std::size_t i, double strain) const {
  const Settings& n = model_.options.settings;
  const VecD<D> x =
      position_of(state_.particles, i, state_.layout.particle_blocks[b], n.dx, n.basis);
  std::ostringstream message;
  message << "particle " << state_.particles.id[i] << " at (" << x[0];
  for (int d = 1; d < D; ++d) message << ", " << x[d];
  message << ") m, t = " << time() << " s: ";
  if (std::isfinite(strain))
    message << "its elastic strain has reached " << strain << ", more than can be resolved ("
            << elastic_strain_limit << "); snow.youngs_modulus is too small for such speeds";
  else
    message << "its state is no longer finite; try a smaller numerics.courant_factor or double "
               "precision";
  return message.str();
}

template <class T, int D>
BlockStats SolverImpl<T, D>::probe(const StepParameters<T>& step, const ParticleView<T>& view,
                                   std::int32_t b) {
  const T* velocities[neighbour_count<D>];
  velocities_around(b, velocities);
  BlockStats stats = BlockStats::reaching(workspace_.grid.block_stats[b].reach);
  model_.kernels.probe(step, view, state_.layout.first[b],
                       state_.layout.first[b + 1] - state_.layout.first[b], velocities, stats);
  return stats;
}

template class SolverImpl<float, 2>;
template class SolverImpl<float, 3>;
template class SolverImpl<double, 2>;
template class SolverImpl<double, 3>;

std::unique_ptr<Solver> make_solver(Options options) {
  if (options.settings.device == DeviceSetting::gpu)
    throw InputError("/numerics/device", "is \"gpu\", but no card was opened for this solver");
  const bool single = options.settings.precision == Precision::float32;
  if (options.dimension == 2) {
    if (single) return std::make_unique<SolverImpl<float, 2>>(std::move(options));
    return std::make_unique<SolverImpl<double, 2>>(std::move(options));
  }
  if (single) return std::make_unique<SolverImpl<float, 3>>(std::move(options));
  return std::make_unique<SolverImpl<double, 3>>(std::move(options));
}

}  // namespace snowshed::methods::mpm
