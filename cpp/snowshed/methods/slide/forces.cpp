#include "snowshed/methods/slide/forces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace snowshed::methods::slide {
namespace {

constexpr double min_speed = 1e-6;  // m/s

/// The node nearest to a position.
std::size_t nearest_node(const Terrain& terrain, const geometry::CellPosition& p) {
  return terrain.index(p.column + int(p.east >= 0.5), p.row + int(p.north >= 0.5));
}

/// Lets a particle entrain snow, which slows it down; returns the snow's mass, kg.
double entrain(const Model& model, double erodible, double stress, double area, double dt,
               double speed, double& mass, Vec3& u) {
  const Settings& s = model.settings;
  double entrained_mass, loosened_area;  // kg, m2
  if (s.erosion_energy > 0) {
    entrained_mass = area * stress * speed * dt / s.erosion_energy;
    loosened_area = area;
  } else {
    entrained_mass = erodible * std::sqrt(area) * speed * dt;
    loosened_area = erodible / s.entrained_density;
  }
  if (!model.compatible())
    entrained_mass = std::min(entrained_mass, erodible * area);  // no more than there is
  const double energy = loosened_area * s.entrainment_shear + entrained_mass * s.entrainment_work;
  u *= mass / (mass + entrained_mass);
  mass += entrained_mass;
  if (energy > 0) u *= std::max(0.0, 1 - energy / (0.5 * mass * (speed * speed + min_speed)));
  return entrained_mass;
}

/// Entrainment by one particle; returns the entrained mass, kg.
double entrain_by(const Model& model, const State& state, View& v, Particles& p, std::size_t i,
                  std::size_t node) {
  const double density = model.settings.density, dt = state.step;
  const double h = std::max(v.thickness[i], min_thickness), speed = v.speed[i];
  const double normal_acceleration =
      model.friction.friction > 0 ? v.coulomb_deceleration[i] / model.friction.friction : 0.0;
  const double stress = v.drag[i] > 0 || normal_acceleration > 0
                            ? model.friction.stress(normal_acceleration * density * h, speed)
                            : 0.0;
  Vec3 u{p.ux[i], p.uy[i], p.uz[i]};
  const Vec3 before = u;
  const double entrained_mass = entrain(model, state.erodible[node], stress,
                                        p.mass[i] / (h * density), dt, speed, p.mass[i], u);
  p.ux[i] = u.x();
  p.uy[i] = u.y();
  p.uz[i] = u.z();
  double* predicted = v.predicted + 4 * i;
  for (int axis = 0; axis < 3; ++axis) predicted[axis] += dt * (u[axis] - before[axis]);
  return entrained_mass;
}

/// Applies entrainment, and the resistance of forest and buildings.
void apply_entrainment_and_resistance(const Model& model, State& state, Workspace& work) {
  View v = view_of(model, state, work);
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::size_t node = nearest_node(model.terrain, work.cell_positions.at(i));
    if (!work.entrained.empty())
      work.entrained[i] = state.erodible[node] > 0 ? entrain_by(model, state, v, p, i, node) : 0.0;
    if (!model.resistance.empty())
      v.drag[i] += model.resistance[node] / std::max(v.thickness[i], min_thickness);
    if (model.compatible() && !work.entrained.empty()) {  // there forces act on the mass before
      const double share = 1 - work.entrained[i] / p.mass[i];
      for (double* load : {v.ax, v.ay, v.az, v.coulomb_deceleration, v.drag}) load[i] *= share;
    }
  }
  for (std::size_t i = 0; i < work.entrained.size(); ++i) {
    if (work.entrained[i] == 0) continue;
    const std::size_t node = nearest_node(model.terrain, work.cell_positions.at(i));
    double& rest = state.erodible[node];
    rest = std::max(0.0, rest - work.entrained[i] / model.terrain.nodes()[node].area);
    state.balance.entrained += work.entrained[i];
  }
}

}  // namespace

void apply_ground(const Model& model, State& state, Workspace& work) {
  const std::size_t n = state.particles.size();
  const View view = view_of(model, state, work);
  for_each_piece(work, n, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    chosen_kernels().ground(view, begin, end);
  });
  if (!state.erodible.empty() || !model.resistance.empty())
    apply_entrainment_and_resistance(model, state, work);
}

void apply_neighbours(const Model& model, State& state, Workspace& work) {
  if (!work.entrained.empty()) work.cells.copy_masses(state.particles.mass);
  const View view = view_of(model, state, work);
  const Kernels& kernels = chosen_kernels();
  const std::ptrdiff_t rows = work.cells.rows() - 2;  // the margin holds no particles
  if (!model.compatible())
    parallel_pieces(rows, work.threads, 1, [&](std::ptrdiff_t j, std::ptrdiff_t) {
      kernels.weigh_pressure(view, int(j) + 1);
    });
  const auto pressure = model.compatible() ? kernels.map_pressure : kernels.surface_pressure;
  std::atomic<bool> breaks{false};
  parallel_pieces(
      work.threads,
      PieceLoop{rows, 1, [&](std::ptrdiff_t j, std::ptrdiff_t) { pressure(view, int(j) + 1); }},
      PieceLoop{std::ptrdiff_t(state.bonds.size()), particles_in_piece,
                [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                  if (kernels.stretch_bonds(view, begin, end)) breaks = true;
                }});
  work.bonds_break = breaks;
}

void remove_broken(State& state, Workspace& work) {
  if (!work.bonds_break) return;
  remove_bonds(state.bonds, work.broken);
  work.bond_lists.update(state.bonds, state.particles.size());
}

}  // namespace snowshed::methods::slide
