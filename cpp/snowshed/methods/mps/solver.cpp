#include "snowshed/methods/mps/solver.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/mps/anderson.hpp"
#include "snowshed/methods/mps/elastic_strain.hpp"
#include "snowshed/methods/mps/solver_impl.hpp"

namespace snowshed::methods::mps {
namespace {

/// If a particle would move farther than this (in l0), the step is repeated with half its length,
/// at most `max_halvings` times, because the particle could pass through a wall.
constexpr double max_distance = 0.5;
constexpr int max_halvings = 20;

/// With conservative gradients pairs repel each other by the sum of their pressures, as springs do.
/// A disturbance runs through the lattice at about 2 sqrt(p/rho). A step is at most this number
/// times l0/sqrt(p/rho) (form and number are ours; above 1 columns of water break up).
constexpr double pressure_courant = 0.5;

/// The share of the last step's viscous force that the pressure of flowing snow takes into account.
/// Without it stiff fluids are compressed more, because viscosity acts last. With 0.9 the pressure
/// of a column of 1e4 Pa s at rest was 1.4 % too low (ours).
constexpr double viscous_share_uncoupled = 0.5;

/// The same for elastic snow, whether it flows or not, so that the pressure bears the stress of
/// snow at rest. With 1 the pressures of a sliding slab alternate from step to step (ours).
constexpr double viscous_share_elastic = 0.75;

/// Pressure and viscosity are solved together under three conditions; u is the root mean square of
/// the speeds.
/// - The fluid is stiff: its plastic viscosity eta is at least `min_stiffness` rho l0^2/dt.
/// - The fluid moves: u exceeds `min_fall` times rho g l0^2/eta, the terminal speed of a fall over
///   one spacing. In a stiff fluid at rest errors of the gradients would cause large pressures,
///   because pressures hardly move such a fluid.
/// - The fluid creeps: rho u^3/(eta g), the square of the Reynolds number of a body whose height
///   makes it flow at u, is less than `max_inertia`. Fast flows lose no volume even without
///   coupling, so they use the cheaper separate solves at every l0.
constexpr double min_stiffness = 2, min_fall = 2, max_inertia = 1e-3;
/// Fraction of the last step's viscous force with which the iteration begins. Below 1, errors of
/// the pressure die out.
constexpr double viscous_share_first_iteration = 0.9;
/// The iteration ends when the force per mass changes by less than this fraction of gravity, or
/// after `max_couplings` iterations. Even if they do not converge, they are better than a single
/// iteration.
constexpr double coupling_tolerance = 3e-3;
constexpr int max_couplings = 20;

void require_converged(const SolveReport& report, const char* what, int max_iterations) {
  if (report.converged) return;
  throw SimulationError(
      std::string("the ") + what + " equation has not converged: " + show_rounded(report.residual) +
      " of its right-hand side is left after " + std::to_string(report.iterations) +
      " iterations; allowed: " + std::to_string(max_iterations));
}

/// Adds a solve to a total. Iterations are summed; residual and convergence are those of the last
/// solve.
void add_solve(const SolveReport& solve, SolveReport& total) {
  total = {total.iterations + solve.iterations, solve.residual, solve.converged};
}

}  // namespace

void check_order(const Settings& s) {
  if (s.order == Order::published && s.splitting == Splitting::pressure_first)
    throw InputError("/numerics/splitting",
                     "with /numerics/order \"published\" particles move before the pressure is "
                     "known; allowed: viscosity_first");
}

std::unique_ptr<Solver> make_solver(Options options) {
  const Settings& s = options.settings;
  if (options.period > 0 && options.period < 3 * s.radius * s.spacing)
    throw InputError("period", show_rounded(options.period) + " m is less than three radii");
  check_order(s);
  if (options.dimension == 2) return std::make_unique<SolverImpl<2>>(std::move(options));
  return std::make_unique<SolverImpl<3>>(std::move(options));
}

template <int D>
Model<D>::Model(Options o)
    : options(std::move(o)),
      gravity(section<D>(options.gravity)),
      kernel(kernel_constants(D, options.settings.radius)),
      second_layer(second_layer_share(D, kernel)),
      surface_deficit(second_layer_deficit(D, kernel)),
      surface_difference(mps::surface_difference(D, kernel)),
      rheology(Rheology::from(options.settings)),
      threads(threads_to_use(options.settings.threads)) {
  for (Obstacle& o : options.obstacles)
    o.shape = thickened_for_particles(o.shape, options.settings.spacing, D).shape;
}

template <int D>
double SolverImpl<D>::largest_speed(const Particles<D>& particles) const {
  double fastest2 = 0;
  for (const VecD<D>& u : particles.velocity) {
    const double speed2 = u.squaredNorm();
    if (!(speed2 <= fastest2)) fastest2 = speed2;  // also if NaN
  }
  return std::sqrt(fastest2);
}

template <int D>
double SolverImpl<D>::pressure_step(const Particles<D>& particles) const {
  const Settings& s = model_.settings();
  if (s.gradient == Gradient::corrected) return HUGE_VAL;
  double highest = 0;
  for (const double p : particles.pressure) highest = std::max(highest, p);
  return highest > 0 ? pressure_courant * s.spacing * std::sqrt(s.density / highest) : HUGE_VAL;
}

/// The longest step in which no particle moves farther than the Courant factor times the spacing,
/// also with the speed that gravity adds in it: (u + g dt) dt = C l0. Viscosity is implicit and
/// does not limit the step.
template <int D>
double SolverImpl<D>::choose_step(const Particles<D>& particles) const {
  const Settings& s = model_.settings();
  const double speed =
      std::max(largest_speed(particles), largest_wall_speed(workspace_.near.contacts));
  const double g = model_.gravity.norm(), distance = s.courant_factor * s.spacing;
  const double root = std::sqrt(speed * speed + 4 * g * distance);
  double dt = std::min(s.max_time_step, pressure_step(particles));
  if (speed + root > 0) dt = std::min(dt, 2 * distance / (speed + root));
  if (!(dt > 1e-9 * s.max_time_step))
    throw SimulationError("the time step has fallen to " + show_rounded(dt) +
                          " s: a particle moves at " + show_rounded(speed) + " m/s");
  return dt;
}

template <int D>
void SolverImpl<D>::move(double dt, Particles<D>& particles) const {
  const double period = model_.options.period;
  for_each_particle(particles.size(), model_.threads_for(particles.size()), [&](std::size_t i) {
    if (!particles.moves(i)) return;
    particles.position[i] += dt * particles.velocity[i];
    if (period > 0)
      particles.position[i][0] -= period * std::floor(particles.position[i][0] / period);
  });
}

/// Computes the velocities and pressures after a step of dt; `next` holds those before it.
template <int D>
void SolverImpl<D>::try_step(double dt, State<D>& next) {
  add_gravity(model_, dt, next.particles);
  if (model_.settings().splitting == Splitting::pressure_first)
    solve_pressure_first(dt, next);
  else
    solve_viscosity_first(dt, next);
}

template <int D>
void SolverImpl<D>::apply_viscosity(double dt, State<D>& next) {
  Particles<D>& p = next.particles;
  const AlignedVector<VecD<D>> before = p.velocity;
  smooth_pressures(model_, p, workspace_);
  next.solves.viscosity = mps::apply_viscosity(model_, dt, p, workspace_);
  require_converged(next.solves.viscosity, "viscous", model_.settings().max_iterations);
  for (std::size_t i = 0; i < p.size(); ++i)
    p.viscous_acceleration[i] = (p.velocity[i] - before[i]) / dt;
  if (forces_) record_drag(dt, p);
  energy_recorder_.after_viscosity(before, p);
}

/// Whether pressure and viscosity of a step are solved together.
template <int D>
bool SolverImpl<D>::is_coupled(double dt) const {
  const Settings& s = model_.settings();
  if (s.coupling != Coupling::stiff) return s.coupling == Coupling::always;
  const double per_speed = s.viscosity / (s.density * s.spacing * s.spacing);  // 1/s
  if (dt * per_speed < min_stiffness) return false;
  double square = 0;
  for (const VecD<D>& u : workspace_.before) square += u.squaredNorm();
  const double speed = std::sqrt(square / double(workspace_.before.size()));
  const double g = model_.gravity.norm();
  return per_speed * speed > min_fall * g &&
         s.density * speed * speed * speed < max_inertia * s.viscosity * g;
}

/// The pressure acts before viscosity, so that unyielded snow does not move. In flowing snow it
/// takes a share of the last step's viscous force into account. Viscosity may still compress the
/// snow: the next step's pressure corrects this, or, in coupled steps, both are iterated with
/// Anderson acceleration until the force converges (ours).
template <int D>
void SolverImpl<D>::solve_pressure_first(double dt, State<D>& next) {
  Particles<D>& p = next.particles;
  const std::size_t n = p.size();
  const int threads = model_.threads_for(n);
  const bool coupled = is_coupled(dt), elastic = model_.is_elastic();
  const double share = coupled   ? viscous_share_first_iteration
                       : elastic ? viscous_share_elastic
                                 : viscous_share_uncoupled;
  prepare_pressure(model_, p, model_.rheology.is_newtonian() && !coupled, workspace_);
  SplitForces<D>& split = workspace_.splitting;
  split.predicted_velocity = p.velocity;
  split.flowing.resize(n);
  split.expected_viscous_acceleration.resize(n);
  for_each_particle(n, threads, [&](std::size_t i) {
    split.flowing[i] = p.moves(i) && (elastic || model_.rheology.flows(p.shear_rate[i]));
    split.expected_viscous_acceleration[i].setZero();
    if (split.flowing[i])
      split.expected_viscous_acceleration[i] = share * p.viscous_acceleration[i];
  });
  AndersonMixing<D> mixing;
  SolveReport pressure, viscosity;
  for (int k = 0;; ++k) {
    for_each_particle(n, threads, [&](std::size_t i) {
      p.velocity[i] = split.predicted_velocity[i] + dt * split.expected_viscous_acceleration[i];
    });
    solve_with_expected_force(dt, next);
    add_solve(next.solves.pressure, pressure);
    add_solve(next.solves.viscosity, viscosity);
    if (!coupled || k + 1 == max_couplings) break;
    split.viscous_acceleration = p.viscous_acceleration;
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!split.flowing[i]) split.viscous_acceleration[i].setZero();
      square +=
          (split.viscous_acceleration[i] - split.expected_viscous_acceleration[i]).squaredNorm();
    }
    const double limit = coupling_tolerance * model_.gravity.norm();
    if (square <= limit * limit * double(n)) break;
    mixing.mix(split.expected_viscous_acceleration, split.viscous_acceleration);
    std::swap(split.expected_viscous_acceleration, split.viscous_acceleration);
  }
  next.solves = {pressure, viscosity};
}

template <int D>
void SolverImpl<D>::solve_with_expected_force(double dt, State<D>& next) {
  Particles<D>& p = next.particles;
  next.solves.pressure = solve_pressure(model_, dt, p, workspace_);
  require_converged(next.solves.pressure, "pressure", model_.settings().max_iterations);
  apply_pressure(model_, dt, p, workspace_);
  for_each_particle(p.size(), model_.threads_for(p.size()), [&](std::size_t i) {
    p.velocity[i] = workspace_.splitting.predicted_velocity[i] + workspace_.change[i];
  });
  apply_viscosity(dt, next);
}

/// Viscosity acts before the pressure, as published.
template <int D>
void SolverImpl<D>::solve_viscosity_first(double dt, State<D>& next) {
  const Settings& s = model_.settings();
  Particles<D>& p = next.particles;
  apply_viscosity(dt, next);
  if (s.order == Order::published) {
    move(dt, p);
    find_neighbours(model_, p, state_.time + dt, workspace_);
  }
  prepare_pressure(model_, p, model_.rheology.is_newtonian(), workspace_);
  next.solves.pressure = solve_pressure(model_, dt, p, workspace_);
  require_converged(next.solves.pressure, "pressure", s.max_iterations);
  apply_pressure(model_, dt, p, workspace_);
  if (s.order == Order::published) {
    std::swap(p.velocity, workspace_.change);
    move(dt, p);
    std::swap(p.velocity, workspace_.change);
  }
}

/// Computes the velocities and pressures after a step, and returns its length.
template <int D>
double SolverImpl<D>::solve_step(const State<D>& start, State<D>& next) {
  double dt = choose_step(start.particles);
  for (int halvings = 0;; ++halvings) {
    try_step(dt, next);
    const double distance = largest_speed(next.particles) * dt;
    if (distance <= max_distance * model_.settings().spacing &&
        dt <= 2 * pressure_step(next.particles))
      return dt;
    if (halvings == max_halvings || !std::isfinite(distance))
      throw SimulationError("a particle would move " + show_rounded(distance) +
                            " m within a step of " + show_rounded(dt) + " s");
    dt *= 0.5;
    next = start;
    ++next.counters.rejected;
  }
}

template <int D>
void SolverImpl<D>::step() {
  if (size() == 0) throw SimulationError("there is no snow");
  State<D>&next = workspace_.next, &start = workspace_.start;
  next = state_;
  if (model_.has_wall_particles())
    workspace_.walls.append_near(state_.time, model_.options.period, model_.particle_mass(),
                                 next.particles);
  find_neighbours(model_, next.particles, state_.time, workspace_);
  start = next;
  workspace_.before = start.particles.velocity;
  energy_recorder_.begin_step(start.particles);
  const double dt = solve_step(start, next);
  if (model_.is_elastic()) update_elastic_strains(model_, dt, next.particles, workspace_);
  keep_spacing(model_, dt, next.particles, workspace_);
  energy_recorder_.after_forces(next.particles);
  if (model_.settings().order == Order::single_move) move(dt, next.particles);
  erode_and_deposit(model_, next.particles, workspace_);
  for (std::size_t i = 0; i < next.particles.size(); ++i)
    next.particles.relative_density[i] = workspace_.near.density[i] / model_.kernel.number_density;
  energy_recorder_.end_step(model_, workspace_, dt, next);
  if (forces_) find_wall_impulses(dt, next);
  if (model_.has_wall_particles()) remove_walls(next.particles);
  next.time += dt;
  next.dt = dt;
  next.pressure_iterations += next.solves.pressure.iterations;
  next.viscosity_iterations += next.solves.viscosity.iterations;
  StepCounters& c = next.counters;
  ++c.steps;
  c.particle_updates += std::int64_t(size());
  c.smallest_dt = c.smallest_dt > 0 ? std::min(c.smallest_dt, dt) : dt;
  std::swap(state_, next);
  if (forces_) record_wall_impulses();
  order_.forget();
}

template <int D>
Report SolverImpl<D>::report() const {
  Report r;
  r.pressure_iterations = state_.solves.pressure.iterations;
  r.viscosity_iterations = state_.solves.viscosity.iterations;
  r.pressure_residual = state_.solves.pressure.residual;
  r.viscosity_residual = state_.solves.viscosity.residual;
  const double steps = double(std::max<std::int64_t>(state_.counters.steps, 1));
  r.mean_pressure_iterations = double(state_.pressure_iterations) / steps;
  r.mean_viscosity_iterations = double(state_.viscosity_iterations) / steps;
  double square = 0, count = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double density = state_.particles.relative_density[i];
    r.largest_density = std::max(r.largest_density, density);
    if (density < model_.settings().surface_ratio) continue;  // at the surface
    square += (density - 1) * (density - 1);
    ++count;
  }
  r.density_error = count > 0 ? std::sqrt(square / count) : 0.0;
  return r;
}

/// Quality of the solutions of the equations, in the last step and on average, and density of the
/// snow.
template <int D>
ReportsRun::Section SolverImpl<D>::run_section() const {
  const Report r = report();
  return {"equations",
          {{"pressure_iterations", std::int64_t(r.pressure_iterations)},
           {"pressure_residual", r.pressure_residual},
           {"mean_pressure_iterations", r.mean_pressure_iterations},
           {"viscosity_iterations", std::int64_t(r.viscosity_iterations)},
           {"viscosity_residual", r.viscosity_residual},
           {"mean_viscosity_iterations", r.mean_viscosity_iterations},
           {"density_error", r.density_error},
           {"largest_density", r.largest_density}}};
}

template struct Model<2>;
template struct Model<3>;
template class SolverImpl<2>;
template class SolverImpl<3>;

}  // namespace snowshed::methods::mps
