// What a solver tells of its particles: energies, and copies for the outside.
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed {

template <class T, int D>
void MpmSolver<T, D>::update_energy_balance() noexcept {
  Progress& p = state_.progress;
  double kinetic = 0, elastic = 0, plastic = 0;
  for (const BlockStats& s : work_.grid.block_stats) {  // of sleeping blocks as they fell asleep
    kinetic += s.kinetic;
    elastic += s.elastic;
    plastic += s.plastic;
  }
  double before = 0, after = 0, work = 0, power = 0;
  for (const BlockStats& s : work_.grid.block_stats) power += s.stress_power;
  for (const NodeStats& s : work_.grid.node_stats) {
    before += s.kinetic_before;
    after += s.kinetic_after;
    work += s.stress_work;
    p.energy.friction += s.friction;
    p.energy.sticking += s.sticking;
    p.energy.impact += s.impact;
  }
  // What particles to grid and grid to particles took.
  p.energy.transfer += (p.energy.kinetic - before) + (after - kinetic);
  // Velocities are those of half a step ago; taken at the time of the positions, the transfer
  // between two steps acts on velocities that have half of the coming step's force in them.
  p.energy.transfer -= 0.5 * (work - p.stress_power * p.dt);
  p.stress_power = power;
  p.energy.plastic += plastic;
  p.energy.kinetic = kinetic;
  p.energy.elastic = elastic;
}

template <class T, int D>
ParticleState MpmSolver<T, D>::state() const {
  const std::vector<std::uint32_t>& at = order_by_id();
  const std::vector<double> x = positions();
  const auto by_id = [&](auto& values, auto value) {
    values.resize(at.size());
    parallel_for_each(std::ptrdiff_t(at.size()), model_.max_threads,
                      [&](std::ptrdiff_t k) { values[k] = value(at[k]); });
  };
  ParticleState s;
  by_id(s.positions, [&](std::size_t i) { return Vec3::Map(&x[3 * i]); });
  by_id(s.velocities, [this](std::size_t i) { return velocity(i); });
  by_id(s.masses, [this](std::size_t i) { return double(state_.particles.mass[i]); });
  by_id(s.volume_ratios, [this](std::size_t i) { return volume_ratio(i); });
  by_id(s.pressures, [this](std::size_t i) { return pressure(i); });
  by_id(s.plastic_strains, [this](std::size_t i) { return plastic_strain(i); });
  if (state_.particles.has_affine) by_id(s.affine, [this](std::size_t i) { return affine(i); });
  by_id(s.ids, [this](std::size_t i) { return state_.particles.id[i]; });
  by_id(s.events, [this](std::size_t i) { return state_.particles.event[i]; });
  if (model_.options.snows.size() > 1)
    by_id(s.material_ids, [this](std::size_t i) { return state_.particles.material_id[i]; });
  s.densities.resize(at.size());
  for (std::size_t k = 0; k < at.size(); ++k)
    s.densities[k] = state_.material_of(model_, at[k]).density / s.volume_ratios[k];
  return s;
}

template <class T, int D>
MotionSummary MpmSolver<T, D>::motion(double speed) const {
  const Particles<T, D>& p = state_.particles;
  return motion_of(
      p.size(), speed, [&p](std::size_t i) { return double(p.mass[i]); },
      [&p](std::size_t i) {
        double v2 = 0;
        for (const auto& v : p.velocity) v2 += double(v[i]) * double(v[i]);
        return v2;
      });
}

template <class T, int D>
std::size_t MpmSolver<T, D>::bytes() const {
  std::size_t total = work_.grid.bytes();
  state_.particles.for_each_array(
      [&total](const char*, const auto& array) { total += bytes_of(array); });
  return total;
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
