// The balance of energy in a step.
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {

void add_step(StepTotals& p, const StepEnergies& step) noexcept {
  const ParticleEnergies& snow = step.particles;
  const NodeEnergies& nodes = step.nodes;
  // Energy that is lost in the transfers from particles to grid and from grid to particles.
  p.energy.transfer += (p.energy.kinetic - nodes.kinetic_before) +
                       (nodes.kinetic_after - snow.kinetic) - snow.damping;
  // Velocities lag half a step behind the positions. The transfer between two steps acts on the
  // velocities at the time of the positions, which contain half of the coming step's force. Its
  // energy therefore differs by half of the change of the stresses' work.
  p.energy.transfer -= 0.5 * (nodes.stress_work - p.stress_power * step.dt);
  p.stress_power = snow.stress_power;
  p.energy.friction += nodes.friction;
  p.energy.sticking += nodes.sticking;
  p.energy.impact += nodes.impact;
  p.energy.damping += snow.damping;
  p.energy.plastic += snow.plastic;
  p.energy.kinetic = snow.kinetic;
  p.energy.elastic = snow.elastic;
}

template <class T, int D>
void SolverImpl<T, D>::update_energy_balance() noexcept {
  StepEnergies step{state_.totals.dt, {}, {}};
  // Sleeping blocks have the energies with which they fell asleep.
  for (const BlockStats& s : workspace_.grid.block_stats) step.particles += s.energy;
  for (const NodeStats& s : workspace_.grid.node_stats) step.nodes += s.energy;
  add_step(state_.totals, step);
}

template void SolverImpl<float, 2>::update_energy_balance() noexcept;
template void SolverImpl<float, 3>::update_energy_balance() noexcept;
template void SolverImpl<double, 2>::update_energy_balance() noexcept;
template void SolverImpl<double, 3>::update_energy_balance() noexcept;

}  // namespace snowshed::methods::mpm
