// The energy balance of a simulation.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace snowshed::methods {

/// The energy balance, J (per metre of width in 2D). The first three are the energies stored now,
/// and `added` is the energy of added snow. The others are sums over all steps of the energy that
/// left the store. `residual` is the energy that the time integration gained (> 0) or lost: the
/// balance closes when it is small beside the rest.
struct EnergyBalance {
  double kinetic = 0, gravitational = 0, elastic = 0;
  double plastic = 0, friction = 0, sticking = 0, impact = 0, transfer = 0;
  double sleep = 0;    // kinetic energy that snow lost as it fell asleep
  double damping = 0;  // damping over a length; the damping of PIC is part of `transfer`
  double added = 0;    // energy of particles when they were added

  double stored() const { return kinetic + gravitational + elastic; }
  double spent() const {
    return plastic + friction + sticking + impact + transfer + sleep + damping;
  }
  double residual() const { return stored() + spent() - added; }

  /// Records that snow with this kinetic energy fell asleep.
  void put_to_sleep(double energy) {
    sleep += energy;
    kinetic -= energy;
  }
};

/// Energies as tables have them: name with unit, J.
using NamedEnergies = std::vector<std::pair<std::string, double>>;

inline std::vector<std::string> names_of(const NamedEnergies& energies) {
  std::vector<std::string> names;
  for (const auto& energy : energies) names.push_back(energy.first);
  return names;
}

/// Returns the energies of the balance with the names of tables, which end in the unit.
inline NamedEnergies named_energies(const EnergyBalance& e) {
  return {{"kinetic_j", e.kinetic},   {"gravitational_j", e.gravitational},
          {"elastic_j", e.elastic},   {"plastic_j", e.plastic},
          {"friction_j", e.friction}, {"sticking_j", e.sticking},
          {"impact_j", e.impact},     {"transfer_j", e.transfer},
          {"sleep_j", e.sleep},       {"damping_j", e.damping},
          {"added_j", e.added},       {"residual_j", e.residual()}};
}

}  // namespace snowshed::methods
