// The energy balance of grains.
#pragma once

#include "snowshed/methods/energy_balance.hpp"

namespace snowshed::methods::grains {

struct Model;
struct State;

/// The energy of grains, J. The first four are the energies stored now; the others are sums over
/// all steps. The balance closes when `residual` is small beside the work.
struct EnergyBalance {
  double kinetic = 0;            // with the scaled masses
  double potential = 0;          // energy of the weight
  double normal = 0, shear = 0;  // elastic
  double friction = 0, damping = 0;
  double broken = 0;    // energy lost when bonds broke
  double boundary = 0;  // work of plates, sides and the cone on the grains
  double added = 0;     // energy of added grains, less that removed with the top plate

  double stored() const { return kinetic + potential + normal + shear; }
  double spent() const { return friction + damping + broken; }
  double residual() const { return stored() + spent() - boundary - added; }
};

/// Returns the energies of the balance with the names of tables, which end in the unit.
NamedEnergies named_energies(const EnergyBalance&);

/// The kinetic energy of all grains, J.
double kinetic_energy(const Model&, const State&);

/// Sets the stored energies of a balance.
void store_energy(const Model&, const State&, EnergyBalance&);

}  // namespace snowshed::methods::grains
