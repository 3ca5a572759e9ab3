#include "snowshed/methods/slide/state.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/available_cores.hpp"

namespace snowshed::methods::slide {
namespace {

/// With twice this share, peak speeds of slides in gullies changed by up to 1.3 %.
constexpr double max_mixed_share = 0.2;

BorderSlope border_slope(const Settings& s) {
  return s.mode == Mode::compatible ? BorderSlope::level_in_the_south_west : BorderSlope::one_sided;
}

/// 1 at nodes within areas of resistance, 0 elsewhere; empty without areas.
std::vector<double> covered_nodes(const Areas& areas, const Terrain& terrain) {
  if (areas.resistance.empty()) return {};
  std::vector<Area> covered = areas.resistance;
  for (Area& area : covered) area.thickness = 1;
  return thickness_at_nodes(covered, terrain, Reach::edge);
}

std::vector<double> resistance_at_nodes(const Settings& s, const Areas& areas,
                                        const Terrain& terrain) {
  std::vector<double> values = covered_nodes(areas, terrain);
  for (double& value : values) value = value > 0 ? s.resistance : 0.0;
  return values;
}

/// The erodible snow at each node, kg/m2; none where snow is released.
std::vector<double> erodible_at_nodes(const Model& model) {
  if (model.areas.entrainment.empty()) return {};
  std::vector<double> values =
      thickness_at_nodes(model.areas.entrainment, model.terrain, Reach::edge);
  const std::vector<double> released =
      released_at_nodes(model.areas.release, model.terrain, model.settings.mode);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = released[i] > 0 ? 0.0 : values[i] * model.settings.entrained_density;
  // Compatible mode: AvaFrame leaves out the nodes of secondary releases, too.
  for (const LateRelease& late : model.late)
    for (const std::size_t node : late.nodes) values[node] = 0.0;
  return values;
}

/// Whether forest stands at each node, if it can be destroyed.
std::vector<std::uint8_t> forest_at_nodes(const Model& model) {
  if (!model.detrains()) return {};
  std::vector<std::uint8_t> values;
  for (const double share : covered_nodes(model.areas, model.terrain)) values.push_back(share > 0);
  return values;
}

}  // namespace

double longest_step(const Settings& s) {
  const double share = s.mode == Mode::improved ? s.time_step * s.mixing_rate : 0.0;
  return s.time_step / std::max(1.0, std::ceil(share / max_mixed_share - 1e-9));
}

Model::Model(const Settings& s, double g, const geometry::HeightField& field, Areas a, bool keeps)
    : settings(s),
      gravity(g),
      terrain(field, border_slope(s)),
      areas(std::move(a)),
      friction(BasalFriction::from(s, g)),
      resistance(resistance_at_nodes(s, areas, terrain)),
      dams(areas.dams, terrain, s.mode == Mode::compatible),
      threads(threads_to_use(s.threads)),
      keeps_energy(keeps) {}

State::State(const Model& model)
    : peaks(std::size_t(model.terrain.columns()) * std::size_t(model.terrain.rows())),
      late(model.late.size(), waiting),
      over_dams(model.dams.size(), 0.0),
      forest(forest_at_nodes(model)),
      erodible(erodible_at_nodes(model)),
      step(longest_step(model.settings)) {
  if (model.settings.changes_ground()) ground.emplace(model.terrain);
  particles.tracks_rest = model.settings.ground_gains_stopped && !model.compatible();
}

void Workspace::reserve_memory(const Model& model, State& state) {
  // Each particle may split.
  const std::size_t now = state.particles.size();
  const std::size_t grown = state.erodible.empty() ? now : 2 * now;
  const std::size_t most = grown + due_particles(model, state);
  state.particles.for_each_array([most](const char*, auto& array) { array.reserve(most); });
  CellPositions::for_each_array(cell_positions, [most](auto& array) { array.reserve(most); });
  thickness.reserve(most);
  loads.resize(now);
  predicted.resize(4 * now);
  pressure_force.resize(4 * now);
  entrained.resize(state.erodible.empty() ? 0 : now);
  removed.resize(now);
  detrained.resize(state.forest.empty() ? 0 : now);
  if (state.ground && model.compatible()) {
    entrained.reserve(state.erodible.empty() ? 0 : most);
    detrained.reserve(state.forest.empty() ? 0 : most);
    for (std::vector<double>& mass : step_changes.mass) mass.resize(state.ground->rise.size());
  }
  gone.resize(state.forest.empty() ? 0 : now);
  if (model.keeps_positions()) positions_before.resize(now);
  if (!model.dams.empty()) passed_dams.reserve(model.dams.sections());
  new_indices.reserve(most);
  piece_sums.resize(most / std::size_t(particles_in_piece) + 1);
  bond_force.resize(4 * state.bonds.size());
  broken.resize(state.bonds.size());
  bond_lists.reserve(most, state.bonds.size());
  cells.reserve(most, model.terrain);
  if (!model.compatible()) {
    // Lanes beyond the last particle have the weight 0, which must not be multiplied by infinity.
    for (AlignedVector<double>* array : {&sorted_pressure_factor, &sorted_column_mass}) {
      array->resize(now + sorted_padding);
      std::fill(array->end() - std::ptrdiff_t(sorted_padding), array->end(), 0.0);
    }
  }
  fields.reserve(model.terrain, !model.compatible());
  if (model.keeps_energy) energy_recorder.reserve(now);
}

namespace {

FrictionScheme friction_scheme(const Model& model) {
  if (!model.compatible()) return FrictionScheme::set_valued;
  return model.settings.explicit_friction ? FrictionScheme::avaframe_explicit
                                          : FrictionScheme::avaframe_implicit;
}

void view_model(const Model& model, const State& state, View& v) {
  const Terrain& t = present_terrain(model, state);
  const Settings& s = model.settings;
  static_assert(sizeof(Terrain::Node) == 4 * sizeof(double), "kernels read records of four");
  v.ground = &t.nodes()->height;
  v.columns = t.columns();
  v.rows = t.rows();
  v.cell = t.cell();
  v.per_cell = 1 / t.cell();
  v.gravity = model.gravity;
  v.density = s.density;
  v.friction = model.friction.friction;
  v.friction_drag = model.friction.drag;
  v.viscosity = s.artificial_viscosity;
  v.across_flow = s.columns == Columns::across_flow;
  v.max_strain = s.max_strain;
  v.bond_modulus = s.bond_modulus;
  v.min_bond_length = s.min_bond_length;
  v.scheme = friction_scheme(model);
  v.added_speed = model.compatible() ? 1e-6 : 0.0;
}

void view_cell_positions(const Model& model, Workspace& work, View& v) {
  CellPositions& p = work.cell_positions;
  v.column = p.column.data();
  v.row = p.row.data();
  v.east = p.east.data();
  v.north = p.north.data();
  v.nx = p.nx.data();
  v.ny = p.ny.data();
  v.nz = p.nz.data();
  v.thickness = work.thickness.data();
  static_assert(sizeof(GridFields::Node) == 4 * sizeof(double) &&
                    sizeof(GridFields::NodeSums) == 4 * sizeof(double),
                "kernels read records of four");
  GridFields::Node* nodes = work.fields.nodes();  // none before the first step
  v.nodes = nodes ? &nodes->thickness : nullptr;
  v.flow = v.nodes;
  v.flow_column = work.fields.first_column();
  v.flow_row = work.fields.first_row();
  v.flow_columns = work.fields.columns();
  v.sorted_x = work.cells.x();
  v.sorted_y = work.cells.y();
  v.sorted_z = model.compatible() ? nullptr : work.cells.z();
  v.sorted_mass = work.cells.mass();
  v.sorted_particle = work.cells.order().data();
  v.cell_begin = work.cells.begins();
  v.cell_columns = work.cells.columns();
  v.cell_rows = work.cells.rows();
}

/// Kernels only read the view of a constant state.
void view_particles(const State& state, View& v) {
  const Particles& p = state.particles;
  v.x = const_cast<double*>(p.x.data());
  v.y = const_cast<double*>(p.y.data());
  v.z = const_cast<double*>(p.z.data());
  v.ux = const_cast<double*>(p.ux.data());
  v.uy = const_cast<double*>(p.uy.data());
  v.uz = const_cast<double*>(p.uz.data());
  v.mass = p.mass.data();
}

void view_loads(Workspace& work, View& v) {
  Loads& l = work.loads;
  v.ax = l.ax.data();
  v.ay = l.ay.data();
  v.az = l.az.data();
  v.coulomb_deceleration = l.coulomb_deceleration.data();
  v.drag = l.drag.data();
  v.speed = l.speed.data();
  v.predicted = work.predicted.data();
  v.pressure_force = work.pressure_force.data();
  v.removed = work.removed.data();
}

void view_bonds(const State& state, Workspace& work, View& v) {
  if (state.bonds.size() == 0) return;
  v.bond_first = state.bonds.first.data();
  v.bond_second = state.bonds.second.data();
  v.rest_length = state.bonds.rest_length.data();
  v.broken = work.broken.data();
  v.bond_force = work.bond_force.data();
  v.bond_begin = work.bond_lists.begins();
  v.bond_entry = work.bond_lists.entries();
}

}  // namespace

View view_of(const Model& model, State& state, Workspace& work) {
  View v{};
  view_model(model, state, v);
  view_cell_positions(model, work, v);
  view_loads(work, v);
  view_particles(state, v);
  view_bonds(state, work, v);
  v.sorted_pressure_factor = work.sorted_pressure_factor.data();
  v.sorted_column_mass = work.sorted_column_mass.data();
  v.time_step = state.step;
  v.mixed_share = state.step * model.settings.mixing_rate;
  return v;
}

void refresh_cell_positions(const Model& model, const State& state, Workspace& work,
                            std::size_t begin, std::size_t end) {
  View view{};
  view_model(model, state, view);
  view_cell_positions(model, work, view);
  view_particles(state, view);
  for_each_piece(work, end - begin, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    const auto from = std::ptrdiff_t(begin);
    chosen_kernels().locate(view, from + first, from + last);
  });
}

void refresh(const Model& model, const State& state, Workspace& work, PeakFields* raised) {
  const std::size_t n = state.particles.size();
  work.threads = model.threads_for(n);
  work.no_particle_splits = false;
  work.cell_positions.resize(n);
  refresh_cell_positions(model, state, work, 0, n);
  work.bond_lists.update(state.bonds, n);
  refresh_fields(model, state, work, raised);
}

namespace {

/// The speed at a node fades if the mass there is less than this share of a particle's mass.
constexpr double share_of_fading = 0.15;

/// The smallest mass that a particle had when it was seeded, kg; 0 without particles.
double lightest(const Particles& p) {
  return p.size() == 0 ? 0.0 : *std::min_element(p.fresh_mass.begin(), p.fresh_mass.end());
}

}  // namespace

void refresh_fields(const Model& model, const State& state, Workspace& work, PeakFields* raised) {
  const Particles& p = state.particles;
  work.cells.update(work.cell_positions.column, work.cell_positions.row);
  work.fields.take_shape(work.cells);
  work.thickness.resize(p.size());
  View view{};
  view_model(model, state, view);
  view_cell_positions(model, work, view);
  view_particles(state, view);
  if (raised) {
    view.peak_thickness = raised->thickness.data();
    view.peak_speed = raised->speed.data();
    if (!model.compatible()) view.sums = &work.fields.sums()->mass;
  }
  // Two neighbouring rows of cells add to the same row of nodes. First the even rows run, and then
  // the odd ones, so that no two threads add to the same node and the sums do not depend on the
  // number of threads.
  for (const int parity : {0, 1})
    parallel_pieces((work.cells.rows() + 1 - parity) / 2, work.threads, 1,
                    [&](std::ptrdiff_t pair, std::ptrdiff_t) {
                      chosen_kernels().sum_on_nodes(view, int(2 * pair) + parity);
                    });
  if (view.sums) {
    view.fading_mass = share_of_fading * lightest(p);
    parallel_pieces(work.cells.rows() + 4, work.threads, 1,
                    [&](std::ptrdiff_t row, std::ptrdiff_t) {
                      chosen_kernels().raise_mean_speed(view, int(row) - 2);
                    });
  }
  for_each_piece(work, p.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    chosen_kernels().thickness(view, begin, end);
  });
}

}  // namespace snowshed::methods::slide
