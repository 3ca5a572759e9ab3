// The energy balance of MPS.
#pragma once

#include "snowshed/methods/mps/state.hpp"

namespace snowshed::methods::mps {

/// Kinetic and gravitational energy of the snow, J.
template <int D>
EnergyBalance stored_energy(const Model<D>&, const Particles<D>&);

/// Records the works of the forces in a step. It is called between the parts of the step, and does
/// nothing unless the balance is kept.
template <int D>
class EnergyRecorder {
 public:
  explicit EnergyRecorder(bool keeps_energy) : active_(keeps_energy) {}

  void begin_step(const Particles<D>&);
  /// `before` has the velocities without viscosity, m/s. A step may apply viscosity several times;
  /// the last time counts.
  void after_viscosity(const AlignedVector<VecD<D>>& before, const Particles<D>&);
  /// Called when all forces have acted on the velocities.
  void after_forces(const Particles<D>&);
  /// Adds the works of the step to the balance. Called before the wall particles are removed.
  void end_step(const Model<D>&, const Workspace<D>&, double dt, State<D>&) const;

 private:
  bool active_;
  AlignedVector<std::uint8_t> moved_;       // whether a particle could move in the step
  AlignedVector<VecD<D>> viscous_, final_;  // velocities after viscosity and all forces, m/s
  AlignedVector<VecD<D>> viscous_change_;   // change of velocities by viscosity, m/s
};

}  // namespace snowshed::methods::mps
