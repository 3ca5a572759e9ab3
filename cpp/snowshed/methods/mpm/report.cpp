// What a solver tells of its particles: energies, and copies for the outside.
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {

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

template <class T, int D>
ParticleState MpmSolver<T, D>::state() const {
  const std::vector<std::uint32_t>& at = order_by_id();
  const std::vector<double> x = positions();
  const auto by_id = [&](auto& values, auto value) {
    values.resize(at.size());
    parallel_for_each(std::ptrdiff_t(at.size()), max_threads_,
                      [&](std::ptrdiff_t k) { values[k] = value(at[k]); });
  };
  ParticleState s;
  by_id(s.positions, [&](std::size_t i) { return Vec3::Map(&x[3 * i]); });
  by_id(s.velocities, [this](std::size_t i) { return velocity(i); });
  by_id(s.masses, [this](std::size_t i) { return double(particles_.mass[i]); });
  by_id(s.volume_ratios, [this](std::size_t i) { return volume_ratio(i); });
  by_id(s.pressures, [this](std::size_t i) { return pressure(i); });
  by_id(s.plastic_strains, [this](std::size_t i) { return plastic_strain(i); });
  if (particles_.has_affine) by_id(s.affine, [this](std::size_t i) { return affine(i); });
  by_id(s.ids, [this](std::size_t i) { return particles_.id[i]; });
  by_id(s.events, [this](std::size_t i) { return particles_.event[i]; });
  if (options_.snows.size() > 1)
    by_id(s.material_ids, [this](std::size_t i) { return particles_.material_id[i]; });
  s.densities.resize(at.size());
  for (std::size_t k = 0; k < at.size(); ++k)
    s.densities[k] = material_of(at[k]).density / s.volume_ratios[k];
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
