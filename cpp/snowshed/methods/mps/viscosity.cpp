// The implicit viscous term.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/anderson.hpp"
#include "snowshed/methods/mps/elastic_strain.hpp"
#include "snowshed/methods/mps/forces.hpp"
#include "snowshed/methods/mps/viscous_stress.hpp"
#include "snowshed/methods/mps/wall_friction.hpp"

namespace snowshed::methods::mps {
namespace {

template <int D>
using Velocities = AlignedVector<VecD<D>>;

/// The coupling of the velocities of each pair, from the viscosity at the shear rate midway between
/// them and at the mean of both pressures. Wall particles have no coupling; walls act by their
/// drag.
template <int D>
void find_couplings(const Model<D>& model, double dt, const Particles<D>& particles,
                    Workspace<D>& work) {
  const double factor = dt / model.settings().density * model.laplacian();
  const Neighbourhood<D>& near = work.near;
  const particles::NeighbourLists<D>& lists = near.lists;
  const Rheology& law = model.rheology;
  const int threads = model.threads_for(lists.size());
  const AlignedVector<float>& weight =
      model.is_elastic() ? work.viscosity.weight : near.isotropic_weight;
  work.viscosity.coupling.resize(lists.pairs());
  const auto for_each_pair = [&](const auto& coupling) {
    for_each_particle(lists.size(), threads, [&](std::size_t i) {
      for (std::uint32_t e = lists.begin(i); e < lists.end(i); ++e) {
        const std::size_t j = lists.neighbour(e);
        coupling(i, j, e, particles.is_wall(i) || particles.is_wall(j));
      }
    });
  };
  const auto set = [&](std::uint32_t e, double viscosity, bool is_wall) {
    work.viscosity.coupling[e] = is_wall ? 0.0f : float(factor * viscosity * double(weight[e]));
  };
  if (law.is_newtonian()) {
    for_each_pair([&](std::size_t, std::size_t, std::uint32_t e, bool is_wall) {
      set(e, law.viscosity, is_wall);
    });
    return;
  }
  work.rates.pair_rate.resize(lists.pairs());
  for_each_piece(lists.size(), threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.pair_rates(near.rows(), near.offsets().data(), particles.velocity.data()->data(),
                             work.rates.gradient.data()->data(),
                             model.is_elastic() ? work.rates.elastic.data()->data() : nullptr,
                             work.rates.pair_rate.data(), begin, end);
  });
  for_each_pair([&](std::size_t i, std::size_t j, std::uint32_t e, bool is_wall) {
    if (j < i) return;
    const double pressure =
        law.friction > 0 ? 0.5 * (work.rates.smooth_pressure[i] + work.rates.smooth_pressure[j])
                         : 0.0;
    const double yield = law.yield_stress(pressure), rate = double(work.rates.pair_rate[e]);
    set(e,
        model.is_elastic() ? law.elastic_viscosity(yield, rate, model.yield_rate(yield, dt))
                           : law.apparent_viscosity(yield, rate),
        is_wall);
  });
  for_each_pair([&](std::size_t i, std::size_t j, std::uint32_t e, bool) {
    if (j < i) work.viscosity.coupling[e] = work.viscosity.coupling[lists.mirror(e)];
  });
}

/// The iterations for the apparent viscosities of a step end when the velocities change by less
/// than this share in an iteration.
constexpr double yield_tolerance = 1e-3;
/// In elastic snow this share of gravity's change in a step is added to the velocities, because
/// errors of a step do not add up: the strain remembers them. With 0.3 slabs near the yield stress
/// accelerated by 5 % too much or too little; with 1 they crept by 1 mm/s.
constexpr double gravity_share = 0.1;
/// The iterations begin at this fraction of the way from the velocities before the step to those
/// predicted without viscosity.
constexpr double first_guess_share = 0.01;

/// Tolerances of an iteration's equation: in the first iteration relative to the change by gravity
/// in a step, and then as a share of the change in the iteration before.
constexpr double max_solve_tolerance = 0.1, solve_share = 0.03;

/// With the diagonal alone few iterations suffice if viscosity does not reach far in a step. After
/// `max_diagonal_iterations` iterations multigrid takes over. Its sweeps of the particles'
/// velocities are damped by `sweep_damping`.
constexpr int max_diagonal_iterations = 12;
constexpr double sweep_damping = 0.9;

/// On the levels above the particles the walls' drag acts equally in all directions.
template <int D>
void prepare_velocity_multigrid(const Model<D>& model, const Particles<D>& particles,
                                Workspace<D>& work) {
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  work.viscosity.diagonal.resize(n);
  work.viscosity.residual.resize(n);
  for_each_particle(n, threads, [&](std::size_t i) {
    work.viscosity.diagonal[i] = work.viscosity.block[i].trace() / D;
  });
  work.viscosity.multigrid.update(work.near.lists, work.viscosity.coupling, work.viscosity.diagonal,
                                  work.near.cells, work.near.cells.period_cells(), threads);
}

/// z = M^-1 r: a damped Jacobi sweep, the levels above, and another sweep.
template <int D, class Apply, class Smooth>
void precondition_velocities(std::size_t n, int threads, const Apply& apply, const Smooth& smooth,
                             Workspace<D>& work, const double* r, double* z) {
  double* const residual = work.viscosity.residual.data()->data();
  const auto find_residual = [&] {
    apply(z, residual);
    for_each_particle(n * D, threads, [&](std::size_t k) { residual[k] = r[k] - residual[k]; });
  };
  const auto damp = [&](double* x) {
    for_each_particle(n * D, threads, [&](std::size_t k) { x[k] *= sweep_damping; });
  };
  smooth(r, z);
  damp(z);
  find_residual();
  work.viscosity.multigrid.correct(residual, z);
  find_residual();
  smooth(residual, residual);
  damp(residual);
  for_each_particle(n * D, threads, [&](std::size_t k) { z[k] += residual[k]; });
}

/// Solves the equation with the present apparent viscosities. `start` holds the velocities before
/// viscosity acts; particles.velocity holds a guess, which the solution replaces.
template <int D>
SolveReport solve_viscosity(const Model<D>& model, double dt, const Velocities<D>& start,
                            double tolerance, double scale, Particles<D>& particles,
                            Workspace<D>& work) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  const Neighbourhood<D>& near = work.near;
  find_couplings(model, dt, particles, work);
  work.viscosity.right_side.resize(n);
  work.viscosity.block.resize(n);
  work.viscosity.inverse_block.resize(n);
  work.viscosity.own_block.resize(n);
  for_each_particle(n, threads, [&](std::size_t i) {
    const bool moves = particles.moves(i);
    double sum = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      sum += double(work.viscosity.coupling[e]);
    WallAction<D> own{Matrix::Identity(), start[i]};
    if (moves) add_wall_action(model, dt, start, particles, i, work, own);
    const Matrix block = own.matrix + sum * Matrix::Identity();
    work.viscosity.right_side[i] = moves ? own.right_side : VecD<D>(VecD<D>::Zero());
    work.viscosity.own_block[i] = moves ? own.matrix : Matrix(Matrix::Zero());
    work.viscosity.block[i] = moves ? block : Matrix(Matrix::Zero());
    work.viscosity.inverse_block[i] = moves ? Matrix(block.inverse()) : Matrix(Matrix::Zero());
  });
  if (model.is_elastic()) add_elastic_force(model, work);

  const auto apply = [&](const double* p, double* q) {
    for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      model.kernels.apply_to_velocities(near.rows(), work.viscosity.coupling.data(),
                                        work.viscosity.block.data()->data(), p, q, begin, end);
    });
  };
  const auto apply_stress = [&](const double* p, double* q) {
    if (model.is_elastic())
      apply_symmetric_stress(model, work, p, q);
    else
      apply(p, q);
  };
  const auto smooth = [&](const double* r, double* z) {
    for_each_particle(n, threads, [&](std::size_t i) {
      VecD<D>::Map(z + i * D) = work.viscosity.inverse_block[i] * VecD<D>::Map(r + i * D);
    });
  };
  const auto solve = [&](int max_iterations, const auto& precondition) {
    return conjugate_gradients(n * D, tolerance, scale, max_iterations, threads, work.cg,
                               particles.velocity.data()->data(),
                               work.viscosity.right_side.data()->data(), apply_stress,
                               precondition);
  };
  const int max_iterations = model.settings().max_iterations;
  const SolveReport first = solve(std::min(max_iterations, max_diagonal_iterations), smooth);
  if (first.converged || max_iterations <= max_diagonal_iterations) return first;
  prepare_velocity_multigrid(model, particles, work);
  const SolveReport second =
      solve(max_iterations - max_diagonal_iterations, [&](const double* r, double* z) {
        precondition_velocities<D>(n, threads, apply, smooth, work, r, z);
      });
  return {first.iterations + second.iterations, second.residual, second.converged};
}

/// Reference for residuals and changes of all velocities, m/s: the norm of their changes due to
/// gravity in a step, plus a thousandth of their own norm.
template <int D>
double velocity_scale(const Model<D>& model, double dt, const Particles<D>& particles) {
  double speed2 = 0;
  for (const VecD<D>& u : particles.velocity) speed2 += u.squaredNorm();
  return std::sqrt(double(particles.size())) * model.gravity.norm() * dt + 1e-3 * std::sqrt(speed2);
}

template <int D>
double norm(const Velocities<D>& a) {
  double square = 0;
  for (const VecD<D>& u : a) square += u.squaredNorm();
  return std::sqrt(square);
}

template <int D>
double distance(const Velocities<D>& a, const Velocities<D>& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]).squaredNorm();
  return std::sqrt(square);
}

/// Replaces the velocities before viscosity acts by a guess of those after it. In elastic snow
/// viscosity is expected to act as in the last step. A viscous fluid begins near the velocities
/// before the step, so that creeping snow comes to rest; but not exactly there, because viscosity
/// would then keep snow at rest for too many iterations.
template <int D>
void set_first_guess(const Model<D>& model, double dt, Particles<D>& particles,
                     const Workspace<D>& work) {
  if (model.rheology.is_newtonian()) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    VecD<D>& u = particles.velocity[i];
    if (!model.is_elastic())
      u = work.before[i] + first_guess_share * (u - work.before[i]);
    else if (particles.moves(i))
      u += dt * particles.viscous_acceleration[i];
  }
}

}  // namespace

template <int D>
void add_gravity(const Model<D>& model, double dt, Particles<D>& particles) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.moves(i)) particles.velocity[i] += dt * model.gravity;
}

/// The apparent viscosity is that of the velocities after the step. It is found by accelerated
/// fixed-point iteration (Kacanov's, which descends for Bingham fluids).
template <int D>
SolveReport apply_viscosity(const Model<D>& model, double dt, Particles<D>& particles,
                            Workspace<D>& work) {
  const Settings& s = model.settings();
  const Velocities<D> start = particles.velocity;
  const bool newtonian = model.rheology.is_newtonian(), elastic = model.is_elastic();
  set_first_guess(model, dt, particles, work);
  const double scale = velocity_scale(model, dt, particles);
  compute_wall_contact_fractions(model, particles, work);
  if (!newtonian) {
    prepare_rates(model, particles, work);
    work.near.lists.find_mirrors(model.threads_for(particles.size()));
  }
  if (elastic) {
    find_stress_weights(model, particles, work);
    find_levers(model, work);
    find_elastic_rates(model, dt, particles, work);
  }
  SolveReport report;
  AndersonMixing<D> mixing;
  Velocities<D> last;
  double tolerance = newtonian ? s.viscosity_tolerance : max_solve_tolerance;
  for (int k = 0; k < std::max(s.yield_iterations, 1); ++k) {
    const bool last_chance = k + 1 >= s.yield_iterations;
    if (last_chance) tolerance = s.viscosity_tolerance;
    tolerance = std::max(tolerance, s.viscosity_tolerance);
    if (!newtonian) find_rates(model, particles, work);
    last = particles.velocity;
    const SolveReport solve = solve_viscosity(model, dt, start, tolerance, scale, particles, work);
    if (elastic) find_wall_reactions(model, dt, start, particles, work);
    report = {report.iterations + solve.iterations, solve.residual, solve.converged};
    if (!solve.converged || newtonian || last_chance) break;
    const double change = distance<D>(particles.velocity, last);
    const double limit =
        yield_tolerance *
        (norm<D>(particles.velocity) + (elastic ? gravity_share : s.viscosity_tolerance) * scale);
    if (change <= limit && tolerance <= s.viscosity_tolerance) break;
    tolerance = change <= 2 * limit ? 0.0 : std::min(tolerance, solve_share * change / scale);
    mixing.mix(last, particles.velocity);
  }
  find_viscosities(model, particles, work);
  return report;
}

template void add_gravity(const Model<2>&, double, Particles<2>&);
template void add_gravity(const Model<3>&, double, Particles<3>&);
template SolveReport apply_viscosity(const Model<2>&, double, Particles<2>&, Workspace<2>&);
template SolveReport apply_viscosity(const Model<3>&, double, Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
