#include "snowshed/methods/slide/energy.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/angles.hpp"
#include "snowshed/methods/slide/columns.hpp"
#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {
namespace {

Vec3 velocity_at(const State& state, std::size_t i) {
  const Particles& p = state.particles;
  return {p.ux[i], p.uy[i], p.uz[i]};
}

/// The integral over length of a bond's force E h L/sqrt(3) (L/L0 - 1).
double bond_energy(double modulus, double thickness, double length, double rest) {
  const double strain = length / rest - 1;
  return modulus * thickness / std::sqrt(3.0) * rest * rest * strain * strain * (0.5 + strain / 3);
}

/// The energy of all bonds between particles of these masses, J.
double bonds_energy(const Model& model, const State& state, const Workspace& work,
                    const double* masses) {
  const Particles& p = state.particles;
  const Bonds& bonds = state.bonds;
  double sum = 0;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const std::uint32_t k = bonds.first[b], l = bonds.second[b];
    const Vec3 separation{p.x[l] - p.x[k], p.y[l] - p.y[k], p.z[l] - p.z[k]};
    const double thickness = 0.5 * (work.thickness[k] + work.thickness[l]);
    const double share = bond_share(model.thins_bonds(), masses, p.fresh_mass.data(), k, l);
    sum += share * bond_energy(model.settings.bond_modulus, thickness, separation.norm(),
                               bonds.rest_length[b]);
  }
  return sum;
}

/// The parts of a particle's friction that grow with the square of its speed, 1/m.
struct Drag {
  double turbulent, resistance;
};
Drag drag_parts(const Model& model, const Workspace& work, std::size_t i) {
  const double h = std::max(work.thickness[i], min_thickness);
  const double all = work.loads.drag[i];
  const double turbulent = std::min(all, model.friction.drag / (model.settings.density * h));
  return model.resistance.empty() ? Drag{all, 0.0} : Drag{turbulent, all - turbulent};
}

/// The sum over the neighbours of a particle of m_l (R - r)^3; R is the width of a cell.
double kernel_mass_sum(const Particles& p, const double* masses, const CellLists& cells,
                       const CellPositions& cell_positions, std::uint32_t i, double radius) {
  const int column = cell_positions.column[i] - cells.first_column();
  const int row = cell_positions.row[i] - cells.first_row();
  double sum = 0;
  for (int k = row - 1; k <= row + 1; ++k)
    for (std::uint32_t e = cells.begin(column - 1, k); e < cells.begin(column + 2, k); ++e) {
      const std::uint32_t l = cells.particle(e);
      const double distance = std::hypot(p.x[l] - p.x[i], p.y[l] - p.y[i], p.z[l] - p.z[i]);
      const double inside = std::max(0.0, radius - distance);
      sum += masses[l] * inside * inside * inside;
    }
  return sum;
}

/// The integral of the factor on the pressure from 0 to n neighbours; see FewNeighbours.
double raised_integral(double n) {
  const double rest = 1 - few_neighbours.power;
  // Up to this number of neighbours the factor is 2.
  const double neighbours_at_factor_2 = std::pow(few_neighbours.factor, 1 / few_neighbours.power);
  if (n <= neighbours_at_factor_2) return 2 * n;
  return neighbours_at_factor_2 + n +
         few_neighbours.factor / rest *
             (std::pow(n, rest) - std::pow(neighbours_at_factor_2, rest));
}

/// The potential energy of the pressure (columns.hpp), J: sum_k m_k g f_k h_k / 2, raised where
/// neighbours are few.
double pressure_energy(const Model& model, const State& state, const Workspace& work,
                       const double* masses) {
  const double radius = model.terrain.cell();
  const Particles& p = state.particles;
  double sum = 0;
  for (std::uint32_t i = 0; i < p.size(); ++i) {
    if (masses[i] == 0) continue;
    const double mass_sum = kernel_mass_sum(p, masses, work.cells, work.cell_positions, i, radius);
    const double neighbours = 10 / (radius * radius * radius) * mass_sum / masses[i];
    const double thickness_of_one = masses[i] / (pi * radius * radius * model.settings.density);
    const bool across_flow = model.settings.columns == Columns::across_flow;
    const double factor =
        column_factor(across_flow, work.cell_positions.nz[i], p.ux[i], p.uy[i], p.uz[i]);
    sum +=
        0.5 * masses[i] * model.gravity * factor * thickness_of_one * raised_integral(neighbours);
  }
  return sum;
}

}  // namespace

NamedEnergies named_energies(const EnergyBalance& e) {
  return {{"kinetic_j", e.kinetic},
          {"potential_j", e.potential},
          {"bonds_j", e.bonds},
          {"coulomb_j", e.coulomb},
          {"turbulent_j", e.turbulent},
          {"resistance_j", e.resistance},
          {"viscosity_j", e.viscosity},
          {"entrainment_j", e.entrainment},
          {"broken_bonds_j", e.broken},
          {"detrainment_j", e.detrainment},
          {"dams_j", e.dams},
          {"ground_j", e.ground},
          {"left_terrain_j", e.left_terrain},
          {"added_j", e.added},
          {"residual_j", e.residual()}};
}

void store_energy(const Model& model, const State& state, const Workspace& work, EnergyBalance& e) {
  const Particles& p = state.particles;
  e.kinetic = 0;
  e.bonds = bonds_energy(model, state, work, p.mass.data());
  e.potential = pressure_energy(model, state, work, p.mass.data());
  for (std::size_t i = 0; i < p.size(); ++i) {
    e.kinetic += 0.5 * p.mass[i] * velocity_at(state, i).squaredNorm();
    e.potential += p.mass[i] * model.gravity * p.z[i];
  }
}

void EnergyRecorder::begin_step(const State& state) {
  const std::size_t n = state.particles.size();
  before_.resize(n);
  for (std::size_t i = 0; i < n; ++i) before_[i] = velocity_at(state, i);
  masses_.assign(state.particles.mass.begin(), state.particles.mass.end());
  heights_.assign(state.particles.z.begin(), state.particles.z.end());
}

void EnergyRecorder::after_ground(const Model& model, const State& state, const Workspace& work,
                                  EnergyBalance& e) {
  for (std::size_t i = 0; i < before_.size(); ++i) {
    const double after_viscosity = work.loads.speed[i] * work.loads.speed[i];
    const Vec3 u = velocity_at(state, i);
    const double mass = state.particles.mass[i];
    e.viscosity += 0.5 * masses_[i] * (before_[i].squaredNorm() - after_viscosity);
    const double detrained = work.detrained.empty() ? 0.0 : work.detrained[i];
    const double grown = mass + detrained;
    e.entrainment += 0.5 * (masses_[i] * after_viscosity - grown * u.squaredNorm());
    if (detrained > 0)
      e.detrainment += detrained * (0.5 * u.squaredNorm() + model.gravity * heights_[i]);
    e.added += (grown - masses_[i]) * model.gravity * heights_[i];
    before_[i] = u;
  }
  add_detrained_stores(model, state, work, e);
}

/// Adds the energy of the thickness and the bonds by which detrainment thins the snow.
void EnergyRecorder::add_detrained_stores(const Model& model, const State& state,
                                          const Workspace& work, EnergyBalance& e) {
  if (work.detrained.empty()) return;
  const Particles& p = state.particles;
  const std::size_t n = p.size();
  masses_.resize(n);
  for (std::size_t i = 0; i < n; ++i) masses_[i] = p.mass[i] + work.detrained[i];
  e.detrainment += pressure_energy(model, state, work, masses_.data()) +
                   bonds_energy(model, state, work, masses_.data());
  for (std::size_t i = 0; i < n; ++i) masses_[i] = work.gone[i] ? 0.0 : p.mass[i];
  e.detrainment -= pressure_energy(model, state, work, masses_.data()) +
                   bonds_energy(model, state, work, masses_.data());
}

/// Adds the energy of the bonds that break in this step.
void EnergyRecorder::add_broken(const Model& model, const State& state, const Workspace& work,
                                EnergyBalance& e) const {
  const Bonds& bonds = state.bonds;
  const Particles& p = state.particles;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const double* k = &work.predicted[4 * std::size_t(bonds.first[b])];
    const double* l = &work.predicted[4 * std::size_t(bonds.second[b])];
    const double length = Vec3(l[0] - k[0], l[1] - k[1], l[2] - k[2]).norm();
    const double share = bond_share(model.thins_bonds(), p.mass.data(), p.fresh_mass.data(),
                                    bonds.first[b], bonds.second[b]);
    if (work.bonds_break && work.broken[b])
      e.broken += share * bond_energy(model.settings.bond_modulus, 0.5 * (k[3] + l[3]), length,
                                      bonds.rest_length[b]);
  }
}

void EnergyRecorder::after_motion(const Model& model, const State& state, const Workspace& work,
                                  EnergyBalance& e) const {
  add_broken(model, state, work, e);
  const Loads& l = work.loads;
  for (std::size_t i = 0; i < before_.size(); ++i) {
    const double mass = state.particles.mass[i];
    const bool is_gone = !work.gone.empty() && work.gone[i];
    if (work.removed[i] || is_gone) {
      double& taken = !work.removed[i]                   ? e.detrainment
                      : work.removed[i] == became_ground ? e.ground
                                                         : e.left_terrain;
      taken += mass * (0.5 * before_[i].squaredNorm() + model.gravity * heights_[i]);
      continue;
    }
    // Friction reduces the velocity, and afterwards the ground turns it.
    const Vec3 accelerated = before_[i] + state.step * Vec3(l.ax[i], l.ay[i], l.az[i]);
    const double after = velocity_at(state, i).norm(), before = accelerated.norm();
    const Vec3 after_friction = before > 0 ? Vec3(accelerated * (after / before)) : accelerated;
    const double work_of_friction =
        0.5 * mass * (accelerated - after_friction).dot(before_[i] + after_friction);
    const Drag drag = drag_parts(model, work, i);
    const double turbulent = drag.turbulent * after * after;
    const double resistance = drag.resistance * after * after;
    const double all = work.loads.coulomb_deceleration[i] + turbulent + resistance;
    if (!(all > 0)) continue;
    e.turbulent += work_of_friction * turbulent / all;
    e.resistance += work_of_friction * resistance / all;
    e.coulomb += work_of_friction * work.loads.coulomb_deceleration[i] / all;
  }
}

}  // namespace snowshed::methods::slide
