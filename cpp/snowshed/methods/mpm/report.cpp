// What a solver tells of its particles: energies, and copies for the outside.
#include <algorithm>
#include <cmath>

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
  const std::size_t n = state_.particles.size();
  const std::vector<std::size_t> at = state_.places_by_id();
  const std::vector<BlockKey> blocks = blocks_of_particles(state_.layout);
  ParticleState s;
  s.positions.reserve(n);
  for (std::size_t i : at) {
    s.positions.push_back(
        embed(position_of(state_.particles, i, blocks[i], model_.options.numerics.dx,
                          model_.options.numerics.basis)));
    VecD<D> v;
    for (int d = 0; d < D; ++d) v[d] = double(state_.particles.velocity[d][i]);
    s.velocities.push_back(embed(v));
    Sym<double, D> a;
    for (int k = 0; k < a.size; ++k) a.c[k] = double(state_.particles.be_minus_identity[k][i]);
    const Material& snow = state_.material_of(model_, i);
    const double elastic_volume = trace(hencky_strain(a));
    const double plastic = state_.particles.has_plastic ? double(state_.particles.plastic[i]) : 0.0;
    s.masses.push_back(double(state_.particles.mass[i]));
    s.plastic_strains.push_back(plastic);
    s.volume_ratios.push_back(std::exp(elastic_volume + plastic - snow.initial_plastic_strain));
    s.densities.push_back(snow.density / s.volume_ratios.back());
    s.pressures.push_back(-snow.elastic.bulk * elastic_volume);
    s.ids.push_back(state_.particles.id[i]);
    s.events.push_back(state_.particles.event[i]);
    if (model_.options.snows.size() > 1) s.material_ids.push_back(state_.particles.material_id[i]);
    if (state_.particles.has_affine) s.affine.push_back(affine_of(state_.particles, i));
  }
  return s;
}

template <class T, int D>
MotionSummary MpmSolver<T, D>::motion(double speed) const {
  MotionSummary m;
  double twice_kinetic = 0;
  for (std::size_t i = 0; i < state_.particles.size(); ++i) {
    double v2 = 0;
    for (const auto& v : state_.particles.velocity) v2 += double(v[i]) * double(v[i]);
    const double mass = double(state_.particles.mass[i]);
    m.mass += mass;
    twice_kinetic += mass * v2;
    if (v2 > speed * speed) m.moving_mass += mass;
  }
  m.rms_speed = m.mass > 0 ? std::sqrt(twice_kinetic / m.mass) : 0;
  return m;
}

template <class T, int D>
std::size_t MpmSolver<T, D>::bytes() const {
  std::size_t total = work_.grid.bytes();
  state_.particles.for_each_array(
      [&total](const char*, const auto& array) { total += array.capacity() * sizeof(array[0]); });
  return total;
}

template class MpmSolver<float, 2>;
template class MpmSolver<float, 3>;
template class MpmSolver<double, 2>;
template class MpmSolver<double, 3>;

}  // namespace snowshed
