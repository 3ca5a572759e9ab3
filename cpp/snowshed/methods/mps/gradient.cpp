// Effect of the pressure on the velocities.
#include <algorithm>
#include <cmath>

#include "snowshed/methods/mps/forces.hpp"

namespace snowshed::methods::mps {
namespace {

/// The smallest distance to which particles approach walls, and the largest distance by which
/// nearer particles are pushed out in a step, in l0.
constexpr double min_wall_distance = 0.25, max_push = 0.1;

/// The least pressure among a particle and its neighbours, Pa.
template <int D>
double least_pressure(const Particles<D>& particles, const Neighbourhood<D>& near, std::size_t i) {
  double min_pressure = particles.pressure[i];
  for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e)
    if (particles.kind[near.lists.neighbour(e)] != Kind::dummy_wall)
      min_pressure = std::min(min_pressure, particles.pressure[near.lists.neighbour(e)]);
  return min_pressure;
}

/// Pressure that a gradient adds to the neighbours' pressures, Pa. `conservative`: the particle's
/// pressure, so that each pair has equal and opposite forces. `corrected`: minus the particle's
/// pressure, so that the corrected gradient of linear pressures is exact. `published`: minus the
/// least pressure around, as in equation (4). At the surface the missing neighbours have the
/// opposite pressure, as in the pressure equation, and the rule of `conservative` holds.
/// (`corrected` would push a particle that protrudes from the surface further out.)
template <int D>
double base_pressure(const Model<D>& model, const Particles<D>& particles,
                     const Neighbourhood<D>& near, std::size_t i) {
  const double own_pressure = particles.pressure[i];
  switch (model.settings().gradient) {
    case Gradient::conservative:
      return own_pressure;
    case Gradient::corrected:
      return near.surface[i] ? own_pressure : -own_pressure;
    case Gradient::published:
      break;
  }
  return -least_pressure(particles, near, i);
}

template <int D>
void find_base_pressures(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  work.pressure.base.resize(particles.size());
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.pressure.base[i] =
        particles.moves(i) ? base_pressure(model, particles, work.near, i) : 0.0;
  });
}

/// The sum of (p_j + base) w r/r^2 over the neighbours, with wall particles. Dummies have the
/// pressure of the particle itself if the gradient is conservative; otherwise they are left out.
template <int D>
void sum_beside_wall_particles(const Model<D>& model, const Particles<D>& particles,
                               Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const bool conservative = model.settings().gradient == Gradient::conservative;
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    VecD<D>& sum = work.pressure.sum[i];
    sum.setZero();
    if (!particles.moves(i)) return;
    for (std::uint32_t e = near.lists.begin(i); e < near.lists.end(i); ++e) {
      const std::size_t j = near.lists.neighbour(e);
      const bool dummy = particles.kind[j] == Kind::dummy_wall;
      if (dummy && !conservative) continue;
      const double other = dummy ? particles.pressure[i] : particles.pressure[j];
      sum += (other + work.pressure.base[i]) * double(near.slope[e]) * near.separation(e);
    }
  });
}

/// The sums over neighbours in gradients of the pressure; times Model::gradient() they are in Pa/m.
template <int D>
void sum_pressures(const Model<D>& model, const Particles<D>& particles, Workspace<D>& work) {
  const Neighbourhood<D>& near = work.near;
  const std::size_t n = particles.size();
  find_base_pressures(model, particles, work);
  work.pressure.sum.resize(n);
  if (model.has_wall_particles()) return sum_beside_wall_particles(model, particles, work);
  for_each_piece(n, model.threads_for(n), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    model.kernels.sum_separations(near.rows(), near.offsets().data(), near.slope.data(),
                                  particles.pressure.data(), work.pressure.base.data(),
                                  work.pressure.sum.data()->data(), begin, end);
  });
}

/// The sum over the images behind walls. The pressure of an image is raised such that it stops a
/// motion into the wall. It is not negative: a wall never pulls.
template <int D>
VecD<D> gradient_at_walls(const Model<D>& model, const Particles<D>& particles,
                          const Neighbourhood<D>& near, std::size_t i, double base, double dt) {
  VecD<D> sum = VecD<D>::Zero();
  const double per_velocity = model.settings().density / dt;
  const bool corrected = model.settings().gradient == Gradient::corrected;
  for (const WallImage<D>* m = near.images.begin(i); m < near.images.end(i); ++m) {
    const double level = particles.pressure[m->neighbour];
    double pressure = level;
    VecD<D> across = VecD<D>::Zero();  // the part of the separation along the normals
    for (const int k : {0, 1}) {
      if (m->mirror_shift[k] == 0) continue;
      const WallContact<D>& wall = near.wall(*m, k);
      pressure -= m->mirror_shift[k] * per_velocity *
                  (particles.velocity[i] - wall.velocity).dot(wall.normal);
      across += m->separation.dot(wall.normal) * wall.normal;
    }
    pressure = std::max(0.0, pressure);
    if (corrected) {
      sum += double(m->slope) * (pressure + base) * m->separation;
      continue;
    }
    // Along the wall the forces between a particle and an image are equal and opposite.
    sum += double(m->slope) * ((level + base) * m->separation + (pressure - level) * across);
  }
  return sum;
}

/// Removes the part of a velocity that would bring the particle too near to a wall within the step.
/// Returns the speed that the particle gains away from the wall, m/s.
template <int D>
double keep_out(const WallContact<D>& c, double spacing, double dt, VecD<D>& velocity) {
  const double approach = (velocity - c.velocity).dot(c.normal);
  const double room = c.distance - min_wall_distance * spacing;
  const double slowest = std::min(-room, max_push * spacing) / dt;
  if (!(approach < slowest)) return 0;
  velocity += (slowest - approach) * c.normal;
  return slowest - approach;
}

}  // namespace

template <int D>
void apply_pressure(const Model<D>& model, double dt, Particles<D>& particles, Workspace<D>& work) {
  const Settings& s = model.settings();
  const Neighbourhood<D>& near = work.near;
  const bool corrected = s.gradient == Gradient::corrected;
  sum_pressures(model, particles, work);
  work.change.resize(particles.size());
  if (work.records_forces) work.wall_stop.assign(near.contacts.all().size(), 0.0);
  for_each_particle(particles.size(), model.threads_for(particles.size()), [&](std::size_t i) {
    work.change[i].setZero();
    if (particles.is_wall(i)) return;
    particles.pressure_acceleration[i].setZero();
    if (!particles.moves(i)) return;
    VecD<D> gradient = work.pressure.sum[i] +
                       gradient_at_walls(model, particles, near, i, work.pressure.base[i], dt);
    if (corrected && !near.surface[i]) gradient = near.correction[i] * gradient;
    particles.pressure_acceleration[i] = model.gradient() / s.density * gradient;
    const VecD<D> before = particles.velocity[i];
    VecD<D> velocity = before - dt * particles.pressure_acceleration[i];
    for (const WallContact<D>* c = near.contacts.begin(i); c < near.contacts.end(i); ++c)
      if (const double gain = keep_out(*c, s.spacing, dt, velocity); work.records_forces)
        work.wall_stop[near.contacts.index_of(c)] = gain;
    work.change[i] = velocity - before;
  });
  for_each_particle(particles.size(), model.threads_for(particles.size()),
                    [&](std::size_t i) { particles.velocity[i] += work.change[i]; });
}

template void apply_pressure(const Model<2>&, double, Particles<2>&, Workspace<2>&);
template void apply_pressure(const Model<3>&, double, Particles<3>&, Workspace<3>&);

}  // namespace snowshed::methods::mps
