// The balance of energy in a step.
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/material/sym_tensor.hpp"
#include "snowshed/methods/mpm/solver_impl.hpp"

namespace snowshed::methods::mpm {

template <class T, int D>
void SolverImpl<T, D>::update_energy_balance() noexcept {
  StepTotals& p = state_.totals;
  double kinetic = 0, elastic = 0, plastic = 0, damping = 0;
  // Sleeping blocks have the energies with which they fell asleep.
  for (const BlockStats& s : workspace_.grid.block_stats) {
    kinetic += s.kinetic;
    elastic += s.elastic;
    plastic += s.plastic;
    damping += s.damping;
  }
  double before = 0, after = 0, work = 0, power = 0;
  for (const BlockStats& s : workspace_.grid.block_stats) power += s.stress_power;
  for (const NodeStats& s : workspace_.grid.node_stats) {
    before += s.kinetic_before;
    after += s.kinetic_after;
    work += s.stress_work;
    p.energy.friction += s.friction;
    p.energy.sticking += s.sticking;
    p.energy.impact += s.impact;
  }
  // Energy that is lost in the transfers from particles to grid and from grid to particles.
  p.energy.transfer += (p.energy.kinetic - before) + (after - kinetic) - damping;
  p.energy.damping += damping;
  // Velocities lag half a step behind the positions. The transfer between two steps acts on the
  // velocities at the time of the positions, which contain half of the coming step's force. Its
  // energy therefore differs by half of the change of the stresses' work.
  p.energy.transfer -= 0.5 * (work - p.stress_power * p.dt);
  p.stress_power = power;
  p.energy.plastic += plastic;
  p.energy.kinetic = kinetic;
  p.energy.elastic = elastic;
}

template void SolverImpl<float, 2>::update_energy_balance() noexcept;
template void SolverImpl<float, 3>::update_energy_balance() noexcept;
template void SolverImpl<double, 2>::update_energy_balance() noexcept;
template void SolverImpl<double, 3>::update_energy_balance() noexcept;

}  // namespace snowshed::methods::mpm
