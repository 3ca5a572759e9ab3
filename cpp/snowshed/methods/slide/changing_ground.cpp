#include "snowshed/methods/slide/changing_ground.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/core/compensated_sum.hpp"
#include "snowshed/methods/slide/advance.hpp"
#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {
namespace {

/// Calls visit(column, row, share) for the four nodes around a position; the shares of a value add
/// up to it.
template <class Visit>
void share_among_nodes(const geometry::CellPosition& p, double value, Visit visit) {
  const double to_east = p.east * value, to_west = value - to_east;
  const double north_east = p.north * to_east, north_west = p.north * to_west;
  visit(p.column, p.row, to_west - north_west);
  visit(p.column + 1, p.row, to_east - north_east);
  visit(p.column, p.row + 1, north_west);
  visit(p.column + 1, p.row + 1, north_east);
}

bool rests(const Particles& p, std::size_t i) {
  return p.ux[i] == 0 && p.uy[i] == 0 && p.uz[i] == 0;
}

}  // namespace

ChangingGround::ChangingGround(const Terrain& first)
    : terrain(first),
      rise(std::size_t(first.columns()) * std::size_t(first.rows()), 0.0),
      waiting(rise),
      stopped(rise) {}

void ChangingGround::add_around(const geometry::CellPosition& p, double depth, bool has_stopped) {
  share_among_nodes(p, depth, [&](int column, int row, double share) {
    add(column, row, share);
    if (has_stopped) stopped[terrain.index(column, row)] += share;
  });
}

void ChangingGround::derive(const Terrain& first) {
  const NodeRectangle all{0, 0, first.columns() - 1, first.rows() - 1};
  terrain.set_rise(first, rise, all);
  waits = {};
  all.for_each([&](int column, int row) {
    if (waiting[terrain.index(column, row)] != 0) waits.include(column, row);
  });
}

std::vector<double> ChangingGround::change() const {
  std::vector<double> sum(rise.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = rise[i] + waiting[i];
  return sum;
}

double ChangingGround::volume() const {
  const std::vector<double> depths = change();
  return compensated_sum(depths.data(), depths.size()) * terrain.cell() * terrain.cell();
}

std::size_t ChangingGround::bytes() const {
  return terrain.bytes() +
         (rise.capacity() + waiting.capacity() + stopped.capacity()) * sizeof(double);
}

const Terrain& present_terrain(const Model& model, const State& state) {
  return state.ground ? state.ground->terrain : model.terrain;
}

// --- as AvaFrame does it ------------------------------------------------------------------------

namespace {

void add_mass(const Terrain& terrain, StepChanges& changes, GroundChange cause,
              const geometry::CellPosition& position, double mass) {
  if (mass == 0) return;
  share_among_nodes(position, mass, [&](int column, int row, double share) {
    changes.mass[std::size_t(cause)][terrain.index(column, row)] += share;
    changes.nodes.include(column, row);
  });
}

bool is_wanted(const Settings& s, GroundChange cause) {
  return cause == GroundChange::stopped     ? s.ground_gains_stopped
         : cause == GroundChange::detrained ? s.ground_gains_detrained
                                            : s.ground_loses_entrained;
}

/// The thickness that a step adds to the ground at a node, normal to it; 0 if it is not wanted.
double thickness_of(const Model& model, const State& state, const StepChanges& changes,
                    GroundChange cause, std::size_t node) {
  const Settings& s = model.settings;
  if (!is_wanted(s, cause)) return 0;
  const double density = cause == GroundChange::entrained ? s.entrained_density : s.density;
  return changes.mass[std::size_t(cause)][node] /
         (present_terrain(model, state).nodes()[node].area * density);
}

constexpr GroundChange all_causes[] = {GroundChange::stopped, GroundChange::detrained,
                                       GroundChange::entrained};

}  // namespace

void mark_stopped(const Model& model, const State& state, Workspace& work) {
  const Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool is_gone = !work.gone.empty() && work.gone[i];
    if (!rests(p, i) || is_gone) continue;
    work.removed[i] = became_ground;
    const Vec3& before = work.positions_before[i];
    add_mass(model.terrain, work.step_changes, GroundChange::stopped,
             model.terrain.cell_position(before.x(), before.y()), p.mass[i]);
  }
}

void take_changes_of_step(const Model& model, State& state, Workspace& work) {
  StepChanges& changes = work.step_changes;
  ChangingGround& ground = *state.ground;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const geometry::CellPosition position = work.cell_positions.at(i);
    if (!work.detrained.empty())
      add_mass(model.terrain, changes, GroundChange::detrained, position, work.detrained[i]);
    if (!work.entrained.empty())
      add_mass(model.terrain, changes, GroundChange::entrained, position, -work.entrained[i]);
  }
  bool exceeds = false;
  changes.nodes.for_each([&](int column, int row) {
    const std::size_t node = model.terrain.index(column, row);
    for (const GroundChange cause : all_causes)
      exceeds = exceeds || std::abs(thickness_of(model, state, changes, cause, node)) >
                               model.settings.ground_min_change;
  });
  const bool is_first_step = state.time == 0;  // in which AvaFrame changes nothing
  changes.nodes.for_each([&](int column, int row) {
    const std::size_t node = model.terrain.index(column, row);
    for (const GroundChange cause : all_causes) {
      // Vertical; at nodes without a slope, area and cell are the same.
      const double depth = thickness_of(model, state, changes, cause, node) *
                           ground.terrain.nodes()[node].area /
                           (ground.terrain.cell() * ground.terrain.cell());
      changes.mass[std::size_t(cause)][node] = 0;
      if (!exceeds || is_first_step || depth == 0) continue;
      ground.add(column, row, depth);
      if (cause == GroundChange::stopped) ground.stopped[node] += depth;
    }
  });
  changes.nodes = {};
}

// --- improved -----------------------------------------------------------------------------------

void count_rest(State& state) {
  Particles& p = state.particles;
  if (!p.tracks_rest) return;
  for (std::size_t i = 0; i < p.size(); ++i) p.rest[i] = rests(p, i) ? p.rest[i] + state.dt : 0.0;
}

namespace {

/// Marks the particles that become ground. Snow that is bonded to snow which has not rested long
/// enough stays, so that no bond to moving snow is cut.
bool mark_rested(const Model& model, const State& state, Workspace& work) {
  const Particles& p = state.particles;
  if (!p.tracks_rest) return false;
  // Rounding of the sum must not add a step.
  const double min_rest = model.settings.ground_rest_time - 1e-9;
  const auto has_rested = [&](std::size_t i) {
    return rests(p, i) && p.rest[i] > 0 && p.rest[i] >= min_rest;  // released snow must try to move
  };
  bool any = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    work.removed[i] = has_rested(i) ? became_ground : char(0);
    any = any || work.removed[i];
  }
  if (!any) return false;
  for (std::size_t b = 0; b < state.bonds.size(); ++b) {
    const std::uint32_t first = state.bonds.first[b], second = state.bonds.second[b];
    if (has_rested(first) != has_rested(second)) work.removed[first] = work.removed[second] = 0;
  }
  return std::any_of(work.removed.begin(), work.removed.begin() + std::ptrdiff_t(p.size()),
                     [](char mark) { return mark != 0; });
}

/// Turns the marked particles into ground.
void bury_marked(const Model& model, State& state, Workspace& work) {
  const Particles& p = state.particles;
  ChangingGround& ground = *state.ground;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (work.removed[i])
      ground.add_around(work.cell_positions.at(i),
                        ground.depth_of(p.mass[i], model.settings.density), true);
  remove_marked(state, work);
  work.reserve_memory(model, state);  // for fewer particles: allocates nothing
}

bool is_due(const Model& model, const ChangingGround& ground) {
  const double min_change = model.compatible() ? 0.0 : model.settings.ground_min_change;
  bool due = false;
  ground.waits.for_each([&](int column, int row) {
    due = due || std::abs(ground.waiting[ground.terrain.index(column, row)]) > min_change;
  });
  return due;
}

void change_ground(const Model& model, ChangingGround& ground) {
  ground.waits.for_each([&](int column, int row) {
    const std::size_t node = ground.terrain.index(column, row);
    ground.rise[node] += ground.waiting[node];
    ground.waiting[node] = 0;
  });
  ground.terrain.set_rise(model.terrain, ground.rise, ground.waits);
  ground.waits = {};
}

/// Puts the snow onto ground that has changed. It keeps its speed.
void put_on_ground(const Terrain& terrain, Particles& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const geometry::CellPosition position = terrain.cell_position(p.x[i], p.y[i]);
    p.z[i] = terrain.height(position);
    if (rests(p, i)) continue;
    const Vec3 u{p.ux[i], p.uy[i], p.uz[i]}, n = terrain.normal(position);
    const Vec3 along = u - u.dot(n) * n;
    const double length = along.norm();
    const Vec3 turned = length > 0 ? Vec3(along * (u.norm() / length)) : Vec3(Vec3::Zero());
    p.ux[i] = turned.x();
    p.uy[i] = turned.y();
    p.uz[i] = turned.z();
  }
}

}  // namespace

bool adapt_ground(const Model& model, State& state, Workspace& work) {
  if (model.compatible()) {
    if (!is_due(model, *state.ground)) return false;
    // As in AvaFrame, the snow's height and thickness stay as they are until it moves.
    change_ground(model, *state.ground);
    refresh_cell_positions(model, state, work, 0, state.particles.size());
    return true;
  }
  const bool some_rested = mark_rested(model, state, work);
  if (!some_rested && !is_due(model, *state.ground)) return false;
  EnergyBalance before, after;
  if (model.keeps_energy) store_energy(model, state, work, before);
  if (some_rested) bury_marked(model, state, work);
  if (is_due(model, *state.ground)) {
    change_ground(model, *state.ground);
    put_on_ground(state.ground->terrain, state.particles);
  }
  refresh(model, state, work);
  if (model.keeps_energy) {
    store_energy(model, state, work, after);
    state.energy.ground += before.stored() - after.stored();
  }
  return true;
}

}  // namespace snowshed::methods::slide
