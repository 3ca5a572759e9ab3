// The pressure equation.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/eigen_solver.hpp"
#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// Computes the velocities of which divergences are taken. Inner wall particles transmit pressure
/// like snow and therefore take the mean velocity of the snow around them; dummy particles behind
/// them ensure that nothing flows into the wall (ours).
template <int D>
void find_divergence_velocities(const Model<D>& model, const Particles<D>& particles,
                                Neighbourhood<D>& near) {
  near.divergence_velocity.resize(particles.size());
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    near.divergence_velocity[i] = particles.velocity[i];
    if (particles.kind[i] != Kind::inner_wall) return;
    VecD<D> sum = VecD<D>::Zero();
    double weight = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      if (particles.is_wall(j)) continue;
      sum += double(near.weight[e]) * particles.velocity[j];
      weight += double(near.weight[e]);
    }
    if (weight > 0) near.divergence_velocity[i] = sum / weight;
  });
}

/// Divergence near walls made of particles, 1/s. Dummy particles contribute the flow into the wall.
template <int D>
double wall_particle_divergence(const Model<D>& model, const Particles<D>& particles,
                                const Neighbourhood<D>& near,
                                const Eigen::Matrix<double, D, D>& correction, std::size_t i) {
  double sum = 0, flow = 0;
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
    const std::size_t j = near.lists.neighbour(e);
    const VecD<D> separation = near.separation(e);
    if (particles.kind[j] == Kind::dummy_wall) {
      const VecD<D>& normal = particles.wall_normal(j);
      flow -= double(near.weight[e]) * separation.dot(normal) *
              (near.divergence_velocity[i] - particles.velocity[j]).dot(normal);
    } else {
      sum +=
          double(near.slope[e]) *
          (correction * separation).dot(near.divergence_velocity[j] - near.divergence_velocity[i]);
    }
  }
  return model.gradient() * sum + model.laplacian() * flow;
}

/// Contribution of mirror images behind walls to the divergence, 1/s. Images move along the wall as
/// their particles do. Flow through the wall is weighted like pressure differences in the
/// Laplacian, so that the two cancel at rest.
template <int D>
double image_divergence(const Model<D>& model, const Particles<D>& particles,
                        const Neighbourhood<D>& near, const Eigen::Matrix<double, D, D>& correction,
                        std::size_t i) {
  const VecD<D>& own_velocity = particles.velocity[i];
  double sum = 0, flow = 0;
  for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m) {
    VecD<D> along = particles.velocity[m->neighbour] - own_velocity;
    for (const int k : {0, 1}) {
      if (m->mirror_shift[k] == 0) continue;
      const WallContact<D>& wall = near.wall(*m, k);
      along -= along.dot(wall.normal) * wall.normal;
      flow +=
          double(m->weight) * m->mirror_shift[k] * (own_velocity - wall.velocity).dot(wall.normal);
    }
    sum += double(m->slope) * (correction * m->separation).dot(along);
  }
  return model.gradient() * sum + model.laplacian() * flow;
}

/// The divergence of the velocity, 1/s.
template <int D>
double divergence(const Model<D>& model, const Particles<D>& particles, const Workspace<D>& work,
                  std::size_t i) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const Neighbourhood<D>& near = work.near;
  const bool corrected = model.settings().gradient == Gradient::corrected && !near.surface[i];
  const Matrix correction = corrected ? near.correction[i] : Matrix(Matrix::Identity());
  if (model.has_wall_particles())
    return wall_particle_divergence(model, particles, near, correction, i);
  return model.gradient() * correction.cwiseProduct(work.rates.gradient[i]).sum() +
         image_divergence(model, particles, near, correction, i);
}

/// Computes the sums that `divergence` needs; the published source needs none.
template <int D>
void prepare_divergence(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  if (model.settings().source == Source::published) return;
  if (model.has_wall_particles())
    find_divergence_velocities(model, particles, work.near);
  else
    sum_velocity_gradients(model, particles, work.near.slope.data(), work);
}

/// Time over which the fraction `compensation` of the density error is removed, s: the larger of dt
/// and the time in which a particle of typical speed travels courant_factor * l0 (at most
/// max_time_step). With dt alone, a single fast particle, which shortens the step, would raise the
/// pressure of all snow. (Ours.)
template <int D>
double compensation_time(const Model<D>& model, double dt, const Particles<D>& particles) {
  const Settings& s = model.settings();
  double square = 0;
  for (const VecD<D>& u : particles.velocity) square += u.squaredNorm();
  const double typical_speed = 3 * std::sqrt(square / double(particles.size())) +
                               std::sqrt(model.gravity.norm() * s.spacing);
  return typical_speed > 0
             ? std::max(dt, std::min(s.max_time_step, s.courant_factor * s.spacing / typical_speed))
             : dt;
}

/// Sources below this fraction of the source due to a particle's own weight count as rounding
/// errors and do not lower the tolerance.
constexpr double min_source = 1e-8;

/// Tolerance of densities below the surface, where particles need not form a lattice.
constexpr double surface_tolerance = 0.002;

/// Excess of density over that of a lattice, which the compensation (ours) reduces. It follows from
/// the filled part of the space. At the surface only a positive excess counts. In the layer below
/// the surface, only the part of a deficit counts that exceeds a lattice's deficit, so that gaps
/// close.
template <int D>
double compensated_excess(const Model<D>& model, const Neighbourhood<D>& near, std::size_t i) {
  const double excess = near.filling[i] - 1;
  if (near.surface[i]) return std::max(excess, 0.0);
  if (!near.below_surface[i] || excess > 0) return excess;
  return std::min(0.0, excess + model.surface_deficit + surface_tolerance);
}

/// The share of the density's error that a step removes. Snow with a yield stress keeps the errors
/// with which it comes to rest, so twice the share is removed while it flows (ours).
template <int D>
double compensated_share(const Model<D>& model) {
  return (model.rheology.is_newtonian() ? 1 : 2) * model.settings().compensation;
}

/// The right-hand side of lap p = ..., Pa/m2: equation (18), or after Tanaka and Masunaga (2010,
/// doi:10.1016/j.jcp.2010.02.011) the divergence of the velocities and the fraction `compensation`
/// of the density error. Their factor 1 - compensation on the divergence would lower pressures at
/// rest by the same fraction; here it is 1.
template <int D>
double source(const Model<D>& model, double dt, double compensation_time,
              const Particles<D>& particles, const Workspace<D>& work, std::size_t i) {
  const Settings& s = model.settings();
  const Neighbourhood<D>& near = work.near;
  if (s.source == Source::published)
    return -s.density / (dt * dt) * (near.density[i] / model.kernel.number_density - 1);
  return s.density / dt * divergence(model, particles, work, i) -
         compensated_share(model) * s.density / (dt * compensation_time) *
             compensated_excess(model, near, i);
}

/// The gradient of the last step's pressure over the density, m/s2; at an inner wall the mean of
/// the snow around, because walls have no acceleration.
template <int D>
VecD<D> last_pressure_acceleration(const Particles<D>& particles, const Neighbourhood<D>& near,
                                   std::size_t i) {
  if (!particles.is_wall(i)) return particles.pressure_acceleration[i];
  VecD<D> sum = VecD<D>::Zero();
  double weight = 0;
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
    const std::size_t j = near.lists.neighbour(e);
    if (particles.is_wall(j)) continue;
    sum += double(near.weight[e]) * particles.pressure_acceleration[j];
    weight += double(near.weight[e]);
  }
  return weight > 0 ? VecD<D>(sum / weight) : sum;
}

/// Subtracts the mean from the sources. The pressure of a fluid without a free surface is defined
/// up to a constant, and its equation has a solution only if the mean of the sources is zero.
template <int D>
void balance_sources(Workspace<D>& work, std::size_t n) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!work.pressure.fixed[i]) {
      sum += work.pressure.source[i];
      ++count;
    }
  for (std::size_t i = 0; i < n; ++i)
    if (!work.pressure.fixed[i]) work.pressure.source[i] -= sum / count;
}

/// The weight of the pressure above the free surface, which is zero there, in the equation of a
/// particle. A linear pressure fulfils the equations of a lattice exactly.
template <int D>
double surface_weight(const Model<D>& model, const Neighbourhood<D>& near, std::size_t i) {
  if (near.surface[i])
    return model.surface_difference * std::max(0.0, model.kernel.number_density - near.density[i]);
  return near.open_moment[i] / (layer_depth(2) * model.settings().spacing);
}

}  // namespace

/// The equation is divided by -2 d/(lambda n0). Its left-hand side is then the sum of w (p_i - p_j)
/// plus the surface term on the diagonal.
template <int D>
void prepare_pressure(const Model<D>& model, const Particles<D>& particles, bool hydrostatic,
                      Workspace<D>& work) {
  Neighbourhood<D>& near = work.near;
  const std::size_t n = particles.size();
  const int threads = model.threads_for(n);
  const double n0 = model.kernel.number_density;
  const bool mirrored = model.settings().surface == Surface::mirrored;
  work.pressure.fixed.resize(n);
  work.pressure.diagonal.resize(n);
  near.open_moment.assign(n, 0.0);
  if (hydrostatic && mirrored) find_open_moments(model, particles, near);
  for_each_particle(n, threads, [&](std::size_t i) {
    work.pressure.fixed[i] =
        particles.kind[i] == Kind::dummy_wall || (near.surface[i] && !mirrored);
    work.pressure.diagonal[i] = 0;
    if (work.pressure.fixed[i]) return;
    double sum = 0;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      if (particles.kind[j] != Kind::dummy_wall)
        sum += double(near.coupling[e]);
      else if (mirrored && near.dry[j] && (near.surface[i] || particles.is_wall(i)))
        sum += 2 * double(near.coupling[e]);  // as if the pressure of j were opposite
    }
    if (mirrored) sum += surface_weight(model, near, i);
    work.pressure.diagonal[i] = std::max(sum, 1e-3 * n0);
  });
  work.pressure.enclosed =
      std::none_of(near.surface.begin(), near.surface.begin() + std::ptrdiff_t(n),
                   [](std::uint8_t at_surface) { return at_surface != 0; });
  if (model.settings().preconditioner == Preconditioner::multigrid)
    work.pressure.multigrid.update(near.lists, near.coupling, work.pressure.diagonal, near.cells,
                                   near.cells.period_cells(), threads);
}

namespace {

/// Solves for work.pressure.values, from its present values.
template <int D>
SolveReport solve(const Model<D>& model, Workspace<D>& work) {
  const Settings& s = model.settings();
  const Neighbourhood<D>& near = work.near;
  const std::size_t n = near.lists.size();
  const int threads = model.threads_for(n);
  const auto apply = [&](const double* p, double* q) {
    for_each_piece(n, threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      model.kernels.apply(near.rows(), near.coupling.data(), work.pressure.diagonal.data(), p, q,
                          begin, end);
    });
  };
  const auto by_conjugate_gradients = [&](const auto& precondition) {
    return conjugate_gradients(n, s.pressure_tolerance, work.pressure.scale, s.max_iterations,
                               threads, work.cg, work.pressure.values.data(),
                               work.pressure.source.data(), apply, precondition);
  };
  if (s.preconditioner == Preconditioner::multigrid)
    return by_conjugate_gradients(
        [&](const double* r, double* z) { work.pressure.multigrid.apply(r, z); });
  if (s.preconditioner == Preconditioner::jacobi)
    return by_conjugate_gradients([&](const double* r, double* z) {
      for_each_particle(n, threads, [&](std::size_t i) {
        z[i] = work.pressure.diagonal[i] > 0 ? r[i] / work.pressure.diagonal[i] : 0.0;
      });
    });
  return solve_with_eigen(near.lists, near.coupling, work.pressure.diagonal, work.pressure.source,
                          s.pressure_tolerance, s.max_iterations, work.pressure.values);
}

}  // namespace

template <int D>
SolveReport solve_pressure(const Model<D>& model, double dt, Particles<D>& particles,
                           Workspace<D>& work) {
  Neighbourhood<D>& near = work.near;
  const std::size_t n = particles.size();
  prepare_divergence(model, particles, work);
  const double relaxation = compensation_time(model, dt, particles);
  // Unevenly distributed neighbours give a linear pressure a nonzero discrete Laplacian. With
  // corrected gradients the source contains it.
  const bool corrected = model.settings().gradient == Gradient::corrected;
  work.pressure.source.resize(n);
  work.pressure.values.resize(n);
  for_each_particle(n, model.threads_for(n), [&](std::size_t i) {
    work.pressure.values[i] = work.pressure.fixed[i] ? 0 : particles.pressure[i];
    work.pressure.source[i] = 0;
    if (work.pressure.fixed[i]) return;
    double value = -source(model, dt, relaxation, particles, work, i) / model.laplacian();
    if (corrected)
      value -= model.settings().density *
               near.asymmetry[i].dot(last_pressure_acceleration(particles, near, i));
    if (near.surface[i]) value = std::max(value, 0.0);  // no suction at the surface
    work.pressure.source[i] = value;
  });
  if (work.pressure.enclosed) balance_sources(work, n);
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) square += work.pressure.source[i] * work.pressure.source[i];
  const double weight = model.settings().density * model.gravity.norm() * model.settings().spacing;
  work.pressure.scale = std::max(std::sqrt(square), min_source * weight * std::sqrt(double(n)));
  const SolveReport report = solve(model, work);
  const double min_value = work.pressure.enclosed
                               ? *std::min_element(work.pressure.values.begin(),
                                                   work.pressure.values.begin() + std::ptrdiff_t(n))
                               : 0.0;
  for (std::size_t i = 0; i < n; ++i)
    particles.pressure[i] =
        work.pressure.fixed[i] ? 0.0 : std::max(0.0, work.pressure.values[i] - min_value);
  return report;
}

template SolveReport solve_pressure(const Model<2>&, double, Particles<2>&, Workspace<2>&);
template SolveReport solve_pressure(const Model<3>&, double, Particles<3>&, Workspace<3>&);
template void prepare_pressure(const Model<2>&, const Particles<2>&, bool, Workspace<2>&);
template void prepare_pressure(const Model<3>&, const Particles<3>&, bool, Workspace<3>&);

}  // namespace snowshed::methods::mps
