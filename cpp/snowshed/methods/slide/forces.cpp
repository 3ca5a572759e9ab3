#include "snowshed/methods/slide/forces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

namespace snowshed::methods::slide {
namespace {

constexpr double min_speed = 1e-6;  // m/s
// m/s; the kernels store up to 1e-15 for snow at rest.
constexpr double max_rest_speed = 2e-15;

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

/// Destroys the forest where snow is too fast or too thick.
void destroy_forest(const Settings& s, const Terrain& terrain, const GridFields& fields,
                    std::vector<std::uint8_t>& forest) {
  for (int j = 0; j < fields.rows(); ++j)
    for (int i = 0; i < fields.columns(); ++i) {
      const int column = fields.first_column() + i, row = fields.first_row() + j;
      if (column < 0 || row < 0 || column >= terrain.columns() || row >= terrain.rows()) continue;
      if (fields.speed_at(column, row) > s.forest_max_speed ||
          fields.thickness_at(column, row) > s.forest_max_thickness)
        forest[terrain.index(column, row)] = 0;
    }
}

/// Whether forest takes snow at a node, or resists it.
enum class ForestAction { none, detrains, resists };

ForestAction forest_action(const Model& model, const State& state, const GridFields& fields,
                           std::size_t node) {
  if (state.forest.empty())
    return model.resistance.empty() ? ForestAction::none : ForestAction::resists;
  if (!state.forest[node]) return ForestAction::none;
  const int columns = model.terrain.columns();
  const int column = int(node) % columns, row = int(node) / columns;
  const bool passes = fields.speed_at(column, row) > model.settings.forest_min_speed &&
                      fields.thickness_at(column, row) > model.settings.forest_min_thickness;
  return passes ? ForestAction::resists : ForestAction::detrains;
}

/// Shares of the fresh mass below which forest takes all of a particle. Among thicker snow a
/// particle loses the same share in each step, so that it would never vanish, but get too light to
/// divide by its mass. AvaFrame has no such limit; with that of the compatible mode maps agree.
constexpr double min_share = 0.01, min_share_as_avaframe = 1e-12;
/// On ground that changes, a particle of any mass decides on the peak speed where it flows alone.
/// This limit only avoids numbers below the smallest.
constexpr double min_share_on_changing_ground = 1e-250;

double min_share_of(const Model& model) {
  if (!model.compatible()) return min_share;
  return model.settings.changes_ground() ? min_share_on_changing_ground : min_share_as_avaframe;
}

/// Takes mass from a particle. A particle that loses all of it keeps its mass to the end of the
/// step, because accelerations are divided by it, but is marked.
void detrain(const Model& model, double area, double dt, double speed, std::size_t i, double& mass,
             double min_mass, Workspace& work) {
  if (!(speed > max_rest_speed)) return;
  const double taken = model.settings.detrainment / speed * dt * area;
  work.gone[i] = taken >= mass - min_mass;
  if (work.gone[i]) return;
  work.detrained[i] = taken;
  mass -= taken;
}

/// Improved mode: adds snow that forest has taken from a particle to the ground.
void add_detrained_ground(const Model& model, State& state, const Workspace& work, std::size_t i,
                          double mass) {
  if (!state.ground || model.compatible() || !model.settings.ground_gains_detrained) return;
  state.ground->add_around(work.cell_positions.at(i),
                           state.ground->depth_of(mass, model.settings.density), false);
}

/// Improved mode: takes the entrained snow from the ground, where it lay.
void take_entrained_ground(const Model& model, State& state, std::size_t node, double mass) {
  if (!state.ground || model.compatible() || !model.settings.ground_loses_entrained) return;
  const int columns = model.terrain.columns();
  state.ground->add(int(node) % columns, int(node) / columns,
                    -state.ground->depth_of(mass, model.settings.entrained_density));
}

/// Applies entrainment, and detrainment and resistance in forest.
void apply_areas(const Model& model, State& state, Workspace& work) {
  View v = view_of(model, state, work);
  Particles& p = state.particles;
  std::fill(work.detrained.begin(), work.detrained.end(), 0.0);
  std::fill(work.gone.begin(), work.gone.end(), 0);
  const double min_mass_share = min_share_of(model);
  if (!state.forest.empty())
    destroy_forest(model.settings, model.terrain, work.fields, state.forest);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::size_t node = nearest_node(model.terrain, work.cell_positions.at(i));
    const double before = p.mass[i], h = std::max(v.thickness[i], min_thickness);
    if (!work.entrained.empty())
      work.entrained[i] = state.erodible[node] > 0 ? entrain_by(model, state, v, p, i, node) : 0.0;
    const ForestAction action = forest_action(model, state, work.fields, node);
    if (action == ForestAction::detrains)
      detrain(model, before / (h * model.settings.density), state.step, v.speed[i], i, p.mass[i],
              min_mass_share * p.fresh_mass[i], work);
    if (action == ForestAction::resists) v.drag[i] += model.resistance[node] / h;
    if (model.compatible() && p.mass[i] != before) {  // there forces act on the mass before
      const double share = before / p.mass[i];
      for (double* load : {v.ax, v.ay, v.az, v.coulomb_deceleration, v.drag}) load[i] *= share;
    }
    if (work.detrained.empty() || work.detrained[i] == 0) continue;
    state.balance.detrained += work.detrained[i];
    add_detrained_ground(model, state, work, i, work.detrained[i]);
  }
  for (std::size_t i = 0; i < work.entrained.size(); ++i) {
    if (work.entrained[i] == 0) continue;
    const std::size_t node = nearest_node(model.terrain, work.cell_positions.at(i));
    double& rest = state.erodible[node];
    rest =
        std::max(0.0, rest - work.entrained[i] / present_terrain(model, state).nodes()[node].area);
    take_entrained_ground(model, state, node, work.entrained[i]);
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
  if (!state.erodible.empty() || !model.resistance.empty()) apply_areas(model, state, work);
}

namespace {

/// Weakens the bonds of snow that forest has thinned. The kernel takes the thickness of the snow
/// around, with which a light particle would be thrown away: force over mass would have no bound.
void weaken_thinned(const State& state, Workspace& work) {
  const Bonds& bonds = state.bonds;
  const Particles& p = state.particles;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const double share =
        bond_share(true, p.mass.data(), p.fresh_mass.data(), bonds.first[b], bonds.second[b]);
    for (std::size_t axis = 0; axis < 3; ++axis) work.bond_force[4 * b + axis] *= share;
  }
}

}  // namespace

void apply_neighbours(const Model& model, State& state, Workspace& work) {
  if (!work.entrained.empty() || !work.detrained.empty())
    work.cells.copy_masses(state.particles.mass, work.gone);
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
  if (model.thins_bonds()) weaken_thinned(state, work);
}

void mark_detrained(const Model& model, State& state, Workspace& work) {
  if (work.gone.empty() || !std::memchr(work.gone.data(), 1, work.gone.size())) return;
  const Particles& p = state.particles;
  for (std::size_t i = 0; i < work.gone.size(); ++i) {
    if (!work.gone[i] || work.removed[i]) {
      work.gone[i] = 0;
      continue;
    }
    work.removed[i] = left_terrain;
    state.balance.detrained += p.mass[i];
    add_detrained_ground(model, state, work, i, p.mass[i]);
    const double square = p.ux[i] * p.ux[i] + p.uy[i] * p.uy[i] + p.uz[i] * p.uz[i];
    state.kinetic_energy -= 0.5 * p.mass[i] * square;
  }
}

void remove_broken(State& state, Workspace& work) {
  if (!work.bonds_break) return;
  remove_bonds(state.bonds, work.broken);
  work.bond_lists.update(state.bonds, state.particles.size());
}

}  // namespace snowshed::methods::slide
