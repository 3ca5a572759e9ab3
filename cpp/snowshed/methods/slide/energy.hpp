// The energy balance of a slide.
#pragma once

#include <vector>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/energy_balance.hpp"

namespace snowshed::methods::slide {

struct Model;
struct State;
struct Workspace;

/// The energy of a slide, J. The first three are the energies stored now, and `added` is the energy
/// of new snow. The others are sums over all steps of the energy that left the store. The balance
/// closes when `residual` is small beside the drop of potential energy.
struct EnergyBalance {
  double kinetic = 0, potential = 0;  // the latter with the energy of the snow's thickness
  double bonds = 0;                   // elastic
  double coulomb = 0, turbulent = 0;  // friction with the ground: mu sigma, and rho g u^2 / xi
  double resistance = 0;              // loss to forest and buildings
  double viscosity = 0;               // artificial
  double entrainment = 0;             // to accelerate entrained snow and to break it loose
  double broken = 0;                  // energy of bonds when they broke
  double detrainment = 0;             // energy of snow that forest took
  double dams = 0;                    // loss to dams
  double ground = 0;                  // energy of snow that became ground, less that of lifted snow
  double left_terrain = 0;            // energy of snow that left the terrain
  double added = 0;                   // energy of snow when it was released or entrained

  double stored() const { return kinetic + potential + bonds; }
  double spent() const {
    return coulomb + turbulent + resistance + viscosity + entrainment + broken + detrainment +
           dams + ground + left_terrain;
  }
  double residual() const { return stored() + spent() - added; }
};

/// Returns the energies of the balance with the names of tables, which end in the unit.
NamedEnergies named_energies(const EnergyBalance&);

/// Sets the stored energies of a balance.
void store_energy(const Model&, const State&, const Workspace&, EnergyBalance&);

/// Records the works of the forces in a step. It is called between the parts of the step, and only
/// reads velocities and loads. The work of a force is its product with the particle's displacement.
/// The works add up to the change of kinetic energy for any length of the step.
class EnergyRecorder {
 public:
  void reserve(std::size_t particles) {
    before_.reserve(particles);
    masses_.reserve(particles);
    heights_.reserve(particles);
  }

  void begin_step(const State&);
  /// Called after friction, viscosity and entrainment are known.
  void after_ground(const Model&, const State&, const Workspace&, EnergyBalance&);
  /// Called before bonds that break and particles that left the terrain are removed.
  void after_motion(const Model&, const State&, const Workspace&, EnergyBalance&) const;

 private:
  void add_detrained_stores(const Model&, const State&, const Workspace&, EnergyBalance&);
  void add_broken(const Model&, const State&, const Workspace&, EnergyBalance&) const;

  std::vector<Vec3> before_;  // m/s
  std::vector<double> masses_, heights_;
};

}  // namespace snowshed::methods::slide
