// Where the energy of grains went.
#pragma once

#include "snowshed/methods/energy_balance.hpp"

namespace snowshed::grains {

struct Model;
struct State;

/// The energy of grains, J. The first four are the present store; the others are sums over all
/// steps. The balance closes when `residual` is small beside the work.
struct EnergyBalance {
  double kinetic = 0;            // with the scaled masses
  double potential = 0;          // energy of the weight
  double normal = 0, shear = 0;  // elastic
  double friction = 0, damping = 0;
  double broken = 0;    // energy that bonds held as they broke
  double boundary = 0;  // work of plates, sides and the cone on the grains
  double added = 0;     // energy of added grains, or removed with the top plate

  double stored() const { return kinetic + potential + normal + shear; }
  double spent() const { return friction + damping + broken; }
  double residual() const { return stored() + spent() - boundary - added; }
};

/// Returns the balance as tables have it, names with units.
NamedEnergies named_energies(const EnergyBalance&);

/// The kinetic energy of all grains, J.
double kinetic_energy(const Model&, const State&);

/// Fills in the energy that is stored now.
void store_energy(const Model&, const State&, EnergyBalance&);

}  // namespace snowshed::grains
