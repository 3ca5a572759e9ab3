// What a solver tells of its particles: energies, and copies for the outside.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {
namespace {

/// A particle's affine matrix in the space (x, y, z); without y in 2D.
template <class T, int D>
Mat3 affine_of(const Particles<T, D>& particles, std::size_t i) {
  const auto axis = [](int d) { return d == D - 1 ? 2 : d; };
  Mat3 c = Mat3::Zero();
  for (int r = 0; r < D; ++r)
    for (int k = 0; k < D; ++k) c(axis(r), axis(k)) = double(particles.affine[r * D + k][i]);
  return c;
}

}  // namespace

template <class T, int D>
void MpmSolver<T, D>::update_energy_balance() {
  double kinetic = 0, elastic = 0, plastic = 0;
  for (const BlockStats& s : grid_.block_stats) {  // of sleeping blocks as they fell asleep
    kinetic += s.kinetic;
    elastic += s.elastic;
    plastic += s.plastic;
  }
  double before = 0, after = 0, work = 0, power = 0;
  for (const BlockStats& s : grid_.block_stats) power += s.stress_power;
  for (const NodeStats& s : grid_.node_stats) {
    before += s.kinetic_before;
    after += s.kinetic_after;
    work += s.stress_work;
    energy_balance_.friction += s.friction;
    energy_balance_.sticking += s.sticking;
    energy_balance_.impact += s.impact;
  }
  // What particles to grid and grid to particles took.
  energy_balance_.transfer += (energy_balance_.kinetic - before) + (after - kinetic);
  // Velocities are those of half a step ago; taken at the time of the positions, the transfer
  // between two steps acts on velocities that have half of the coming step's force in them.
  energy_balance_.transfer -= 0.5 * (work - stress_power_ * dt_);
  stress_power_ = power;
  energy_balance_.plastic += plastic;
  energy_balance_.kinetic = kinetic;
  energy_balance_.elastic = elastic;
}

template <class T, int D>
double MpmSolver<T, D>::gravitational_energy() const {
  double sum = 0;
  for (std::size_t b = 0; b < layout_.particle_blocks.size(); ++b)
    for (std::int32_t i = layout_.first[b]; i < layout_.first[b + 1]; ++i)
      sum += double(particles_.mass[i]) *
             position_of(particles_, std::size_t(i), layout_.particle_blocks[b],
                         options_.numerics.dx, options_.numerics.basis)[D - 1];
  return sum * options_.gravity;
}

template <class T, int D>
double MpmSolver<T, D>::kinetic_energy() const {
  const double inertia = options_.numerics.dx * options_.numerics.dx /
                         (options_.numerics.basis == Basis::quadratic ? 4.0 : 3.0);
  double sum = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    double v2 = 0;
    for (const auto& v : particles_.velocity) v2 += double(v[i]) * double(v[i]);
    if (particles_.has_affine)
      for (const auto& c : particles_.affine) v2 += inertia * double(c[i]) * double(c[i]);
    sum += 0.5 * double(particles_.mass[i]) * v2;
  }
  return sum;
}

template <class T, int D>
double MpmSolver<T, D>::elastic_energy() const {
  double sum = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Material& snow = material_of(i);
    const Elasticity<double>& el = snow.elastic;
    Sym<double, D> a;
    for (int k = 0; k < a.size; ++k) a.c[k] = double(particles_.be_minus_identity[k][i]);
    const Sym<double, D> e = hencky_strain(a);
    const double volumetric = trace(e);
    sum += double(particles_.mass[i]) / snow.density *
           (el.mu * norm_squared(e) + 0.5 * el.lambda * volumetric * volumetric);  // (1.2.5)
  }
  return sum;
}

template <class T, int D>
EnergyBalance MpmSolver<T, D>::energy() const {
  EnergyBalance energy_balance = energy_balance_;
  energy_balance.gravitational = gravitational_energy();
  return energy_balance;
}

/// Where each particle is now, ordered by id: for the outside, particles keep their places.
template <class T, int D>
std::vector<std::size_t> MpmSolver<T, D>::places_by_id() const {
  std::vector<std::size_t> at(particles_.size());
  std::iota(at.begin(), at.end(), std::size_t(0));
  std::sort(at.begin(), at.end(),
            [this](std::size_t a, std::size_t b) { return particles_.id[a] < particles_.id[b]; });
  return at;
}

template <class T, int D>
ParticleState MpmSolver<T, D>::state() const {
  const std::size_t n = particles_.size();
  const std::vector<std::size_t> at = places_by_id();
  const std::vector<BlockKey> blocks = blocks_of_particles(layout_);
  ParticleState s;
  s.positions.reserve(n);
  for (std::size_t i : at) {
    s.positions.push_back(embed(
        position_of(particles_, i, blocks[i], options_.numerics.dx, options_.numerics.basis)));
    VecD<D> v;
    for (int d = 0; d < D; ++d) v[d] = double(particles_.velocity[d][i]);
    s.velocities.push_back(embed(v));
    Sym<double, D> a;
    for (int k = 0; k < a.size; ++k) a.c[k] = double(particles_.be_minus_identity[k][i]);
    const Material& snow = material_of(i);
    const double elastic_volume = trace(hencky_strain(a));
    const double plastic = particles_.has_plastic ? double(particles_.plastic[i]) : 0.0;
    s.masses.push_back(double(particles_.mass[i]));
    s.plastic_strains.push_back(plastic);
    s.volume_ratios.push_back(std::exp(elastic_volume + plastic - snow.initial_plastic_strain));
    s.densities.push_back(snow.density / s.volume_ratios.back());
    s.pressures.push_back(-snow.elastic.bulk * elastic_volume);
    s.ids.push_back(particles_.id[i]);
    s.events.push_back(particles_.event[i]);
    if (options_.snows.size() > 1) s.material_ids.push_back(particles_.material_id[i]);
    if (particles_.has_affine) s.affine.push_back(affine_of(particles_, i));
  }
  return s;
}

template <class T, int D>
MotionSummary MpmSolver<T, D>::motion(double speed) const {
  MotionSummary m;
  double twice_kinetic = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    double v2 = 0;
    for (const auto& v : particles_.velocity) v2 += double(v[i]) * double(v[i]);
    const double mass = double(particles_.mass[i]);
    m.mass += mass;
    twice_kinetic += mass * v2;
    if (v2 > speed * speed) m.moving_mass += mass;
  }
  m.rms_speed = m.mass > 0 ? std::sqrt(twice_kinetic / m.mass) : 0;
  return m;
}

template <class T, int D>
std::size_t MpmSolver<T, D>::bytes() const {
  std::size_t total = grid_.bytes();
  particles_.for_each_array(
      [&total](const char*, const auto& array) { total += array.capacity() * sizeof(array[0]); });
  return total;
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
