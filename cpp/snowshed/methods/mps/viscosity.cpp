// The implicit viscous term.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/anderson.hpp"
#include "snowshed/methods/mps/forces.hpp"
#include "snowshed/methods/mps/viscous_stress.hpp"

namespace snowshed::methods::mps {
namespace {

template <int D>
using Velocities = AlignedVector<VecD<D>>;

/// Lower limit of the wall distance that enters wall friction, in l0.
constexpr double min_friction_distance = 0.25;

/// Weight of a wall particle's friction on a particle that touches its obstacle, m; 0 if the wall
/// particle is not in the layer at the surface.
template <int D>
double friction_weight(const Model<D>& model, float weight, const VecD<D>& to_wall,
                       const WallContact<D>& c) {
  const double below = -to_wall.dot(c.normal);
  const bool at_surface = below - c.distance < model.settings().spacing;
  return at_surface ? double(weight) * std::max(0.0, below) : 0.0;
}

/// Sum of these weights over the particles that touch a wall particle's obstacle, but at least
/// `min_touched_share` times the sum on a lattice, so that a wall particle at the edge of the snow
/// has less friction.
template <int D>
double friction_weight_sum(const Model<D>& model, const Particles<D>& particles,
                           const Neighbourhood<D>& near, std::size_t wall) {
  double sum = 0;
  for (std::uint32_t e = near.lists.begin(wall); e < near.lists.end(wall); ++e) {
    const std::size_t i = near.lists.neighbour(e);
    const WallContact<D>* c =
        particles.is_wall(i) ? nullptr : near.contact_with(i, particles.event[wall]);
    if (c) sum += friction_weight(model, near.weight[e], VecD<D>(-near.separation(e)), *c);
  }
  constexpr double min_touched_share = 0.8;
  const double on_lattice =
      (1 - model.second_layer) / (model.laplacian() * model.settings().spacing);
  return std::max(sum, min_touched_share * on_lattice);
}

/// Computes the fraction of the wall's shear stress that each contact carries. The particles that
/// touch the obstacle around a wall particle divide its friction among them.
template <int D>
void compute_wall_contact_fractions(const Model<D>& model, const Particles<D>& particles,
                                    Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const int threads = model.threads_for(particles.size());
  work.wall_friction.share.resize(near.contacts.all().size());
  if (!model.has_wall_particles()) {
    for (std::size_t k = 0; k < work.wall_friction.share.size(); ++k)
      work.wall_friction.share[k] = share_of_wall(
          near.contacts.all()[k].distance / model.settings().spacing, model.second_layer);
    return;
  }
  work.wall_friction.weight_sum.resize(particles.size());
  for_each_particle(particles.size(), threads, [&](std::size_t j) {
    if (particles.is_wall(j))
      work.wall_friction.weight_sum[j] = friction_weight_sum(model, particles, near, j);
  });
  for_each_particle(particles.size(), threads, [&](std::size_t i) {
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
      double sum = 0;
      for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
        const std::size_t j = near.lists.neighbour(e);
        if (particles.is_wall(j) && particles.event[j] == c->obstacle)
          sum += friction_weight(model, near.weight[e], near.separation(e), *c) /
                 work.wall_friction.weight_sum[j];
      }
      work.wall_friction.share[near.contacts.index_of(c)] = sum;
    }
  });
}

/// The coupling of the velocities of each pair, from the viscosity at the shear rate midway between
/// them and at the mean of both pressures. Wall particles have no coupling; walls act by their
/// drag.
template <int D>
void find_couplings(const Model<D>& model, double factor, const Particles<D>& particles,
                    Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const particles::NeighbourLists<D>& lists = near.lists;
  const Rheology& law = model.rheology;
  const int threads = model.threads_for(lists.size());
  const AlignedVector<float>& weight =
      model.has_symmetric_stress() ? work.viscosity.weight : near.isotropic_weight;
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
                             work.rates.gradient.data()->data(), work.rates.pair_rate.data(), begin,
                             end);
  });
  for_each_pair([&](std::size_t i, std::size_t j, std::uint32_t e, bool is_wall) {
    if (j < i) return;
    const double pressure =
        law.friction > 0 ? 0.5 * (work.rates.smooth_pressure[i] + work.rates.smooth_pressure[j])
                         : 0.0;
    set(e, law.apparent_viscosity(law.yield_stress(pressure), double(work.rates.pair_rate[e])),
        is_wall);
  });
  for_each_pair([&](std::size_t i, std::size_t j, std::uint32_t e, bool) {
    if (j < i) work.viscosity.coupling[e] = work.viscosity.coupling[lists.mirror(e)];
  });
}

/// The iterations for the apparent viscosities of a step end when the velocities change by less
/// than this share in an iteration.
constexpr double yield_tolerance = 1e-3;
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

/// The wall's shear stress is that of snow with the shear rate u/h at the pressure on the wall; u
/// is the speed at which the particle slides, and h is its distance from the wall. The stress acts
/// on the particles next to the wall. If the obstacle is not sticky, the stress is at most the
/// obstacle's own friction. `reaction` is the pressure of the wall's hold, Pa. Returns the drag,
/// 1/s.
template <int D>
double wall_drag(const Model<D>& model, const Particles<D>& particles, double share,
                 double reaction, std::size_t i, const WallContact<D>& c) {
  const Settings& s = model.settings();
  const double height = std::max(c.distance, min_friction_distance * s.spacing);
  if (share == 0) return 0;
  const VecD<D> relative = particles.velocity[i] - c.velocity;
  const double rate = (relative - relative.dot(c.normal) * c.normal).norm() / height;
  const double pressure =
      std::max(0.0, particles.pressure[i] + reaction -
                        s.density * c.distance * particles.pressure_acceleration[i].dot(c.normal));
  const Rheology& law = model.rheology;
  double viscosity = law.apparent_viscosity(law.yield_stress(pressure), rate);
  const ContactLaw& contact = model.options.obstacles[c.obstacle].law;
  if (contact.condition != Condition::sticky)
    viscosity = std::min(viscosity, law.regularised(contact.friction * pressure, rate));
  return share * viscosity / (s.density * s.spacing * height);
}

/// A wall holds the snow that it presses with this many times the inertia of a particle.
constexpr double wall_hold = 1e4;

/// Walls bear the stress of the snow that they press: viscosity does not move its layer next to a
/// wall along the normal. The pressure has no share in this step, and would leave the snow without
/// a support.
template <int D>
double hold_of_wall(const Model<D>& model, const Particles<D>& particles, std::size_t i,
                    const WallContact<D>& c) {
  if (!model.has_symmetric_stress() || !(particles.pressure[i] > 0)) return 0;
  return wall_hold * share_of_wall(c.distance / model.settings().spacing, 0);
}

/// The velocity at which a wall holds a particle: the wall's if the snow is at rest there, so that
/// small errors of the pressure do not move it, and that before viscosity acts if the snow flows.
template <int D>
const VecD<D>& held_velocity(const Model<D>& model, double dt, const Workspace<D>& work,
                             const Velocities<D>& start, std::size_t i, const WallContact<D>& c) {
  return rests(model, dt, VecD<D>(work.before[i] - c.velocity)) ? c.velocity : start[i];
}

/// Finds the pressures by which walls hold the snow, which the pressure equation does not know of.
template <int D>
void find_wall_reactions(const Model<D>& model, double dt, const Velocities<D>& start,
                         const Particles<D>& particles, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const double per_speed = model.settings().density * model.settings().spacing / dt;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
      const std::size_t k = near.contacts.index_of(c);
      const double share = work.wall_friction.share[k];
      const double hold =
          particles.moves(i) && share > 0 ? hold_of_wall(model, particles, i, *c) : 0.0;
      const VecD<D>& held = held_velocity(model, dt, work, start, i, *c);
      work.wall_friction.reaction[k] =
          hold > 0 ? per_speed * hold / share * (held - particles.velocity[i]).dot(c->normal) : 0.0;
    }
  });
}

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
  find_couplings(model, dt / model.settings().density * model.laplacian(), particles, work);
  work.viscosity.right_side.resize(n);
  work.viscosity.block.resize(n);
  work.viscosity.inverse_block.resize(n);
  work.viscosity.own_block.resize(n);
  work.wall_friction.drag.resize(near.contacts.all().size());
  for_each_particle(n, threads, [&](std::size_t i) {
    const bool moves = particles.moves(i);
    double sum = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
      sum += double(work.viscosity.coupling[e]);
    Matrix own = Matrix::Identity();
    VecD<D> right = start[i];
    if (moves)
      for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c) {
        const std::size_t k = near.contacts.index_of(c);
        double& drag = work.wall_friction.drag[k];
        drag = wall_drag(model, particles, work.wall_friction.share[k],
                         work.wall_friction.reaction[k], i, *c);
        const Matrix along = dt * drag * (Matrix::Identity() - c->normal * c->normal.transpose());
        const double hold = hold_of_wall(model, particles, i, *c);
        const Matrix across = hold * c->normal * c->normal.transpose();
        own += along + across;
        right += along * c->velocity + across * held_velocity(model, dt, work, start, i, *c);
      }
    const Matrix block = own + sum * Matrix::Identity();
    work.viscosity.right_side[i] = moves ? right : VecD<D>(VecD<D>::Zero());
    work.viscosity.own_block[i] = moves ? own : Matrix(Matrix::Zero());
    work.viscosity.block[i] = moves ? block : Matrix(Matrix::Zero());
    work.viscosity.inverse_block[i] = moves ? Matrix(block.inverse()) : Matrix(Matrix::Zero());
  });

  const auto apply = [&](const double* p, double* q) {
    for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      model.kernels.apply_to_velocities(near.rows(), work.viscosity.coupling.data(),
                                        work.viscosity.block.data()->data(), p, q, begin, end);
    });
  };
  const auto apply_stress = [&](const double* p, double* q) {
    if (model.has_symmetric_stress())
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
  // The iterations begin near the velocities before the step, not at the velocities after the
  // action of forces, so that creeping snow comes to rest. They do not begin exactly at rest,
  // because viscosity would then keep the snow at rest for too many iterations.
  const Velocities<D> start = particles.velocity;
  const bool newtonian = model.rheology.is_newtonian();
  if (!newtonian)
    for (std::size_t i = 0; i < start.size(); ++i)
      particles.velocity[i] = work.before[i] + first_guess_share * (start[i] - work.before[i]);
  const double scale = velocity_scale(model, dt, particles);
  compute_wall_contact_fractions(model, particles, work);
  work.wall_friction.reaction.assign(work.near.contacts.all().size(), 0.0);
  const bool symmetric = model.has_symmetric_stress();
  if (symmetric) find_stress_weights(model, particles, work);
  if (!newtonian) {
    prepare_rates(model, particles, work);
    work.near.lists.find_mirrors(model.threads_for(particles.size()));
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
    if (symmetric) find_wall_reactions(model, dt, start, particles, work);
    report = {report.iterations + solve.iterations, solve.residual, solve.converged};
    if (!solve.converged || newtonian || last_chance) break;
    const double change = distance<D>(particles.velocity, last);
    const double limit =
        yield_tolerance * (norm<D>(particles.velocity) + s.viscosity_tolerance * scale);
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
