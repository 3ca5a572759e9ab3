#include "snowshed/methods/slide/solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "snowshed/core/compensated_sum.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/slide/advance.hpp"
#include "snowshed/methods/slide/forces.hpp"
#include "snowshed/methods/slide/solver_impl.hpp"

namespace snowshed::methods::slide {
namespace {

/// Steps between two sorts of the particles by their cells.
constexpr int steps_between_sorts = 32;

/// The position of a node on the map as text, m.
std::string on_map(const Terrain& terrain, int column, int row) {
  char text[80];
  std::snprintf(text, sizeof text, "%.10g, %.10g", terrain.west() + column * terrain.cell(),
                terrain.south() + row * terrain.cell());
  return text;
}

/// Throws if a cell under an area lacks a height at one of its nodes.
void check_no_hole(const Terrain& terrain, const geometry::Polygon& area,
                   const std::string& where) {
  double low[2] = {area.outline[0][0], area.outline[0][1]}, high[2] = {low[0], low[1]};
  for (const geometry::Point2& p : area.outline)
    for (const int axis : {0, 1}) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  const double c = terrain.cell();
  const int last_row = std::min(terrain.rows() - 1, int(high[1] / c) + 1);
  const int last_column = std::min(terrain.columns() - 1, int(high[0] / c) + 1);
  for (int row = std::max(0, int(low[1] / c)); row <= last_row; ++row)
    for (int column = std::max(0, int(low[0] / c)); column <= last_column; ++column) {
      const double x = column * c, y = row * c;
      if (std::isnan(terrain.node(column, row).height) &&
          geometry::area_within(area, {x - c, y - c}, {x + c, y + c}) > 0)
        throw InputError(where, "the terrain has a hole there: no elevation at (" +
                                    on_map(terrain, column, row) + ")");
    }
}

/// Largest number of steps that stiff bonds may need in place of one.
constexpr double max_substeps = 100;

void check_on_terrain(const Terrain& terrain, const std::vector<Area>& areas,
                      const std::string& kind) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const std::string where = "/terrain/" + kind + "/" + std::to_string(i);
    for (const geometry::Point2& p : areas[i].polygon.outline) {
      if (!terrain.cell_position(p[0], p[1]).inside())
        throw InputError(
            where, "reaches beyond the terrain, which extends from (" + on_map(terrain, 0, 0) +
                       ") to (" + on_map(terrain, terrain.columns() - 1, terrain.rows() - 1) + ")");
    }
    check_no_hole(terrain, areas[i].polygon, where);
  }
}

/// The unit vector of steepest descent; zero on level ground.
Vec3 fall_line(const Terrain& terrain, const geometry::CellPosition& position) {
  const Vec3 n = terrain.normal(position);
  const Vec3 down = n.z() * n - Vec3::UnitZ();
  const double length = down.norm();
  return length > 0 ? Vec3(down / length) : Vec3(Vec3::Zero());
}

}  // namespace

std::unique_ptr<Solver> make_solver(Options options) {
  return std::make_unique<SolverImpl>(std::move(options));
}

SolverImpl::SolverImpl(Options o)
    : model_(o.settings, o.gravity, o.terrain, std::move(o.areas), o.energy), state_(model_) {
  check_on_terrain(model_.terrain, model_.areas.release, "release");
  std::vector<Area> areas = late_areas(model_.areas);
  std::vector<Area> inflows;
  for (const Inflow& inflow : model_.areas.inflows) inflows.push_back(inflow.area);
  check_on_terrain(model_.terrain, model_.areas.secondary_release, "secondary_release");
  check_on_terrain(model_.terrain, inflows, "inflows");
  areas.insert(areas.begin(), model_.areas.release.begin(), model_.areas.release.end());
  check_effort(model_.settings, model_.terrain, areas);
  model_.late = prepare_late_releases(model_.settings, model_.terrain, model_.areas);
  state_ = State(model_);
  state_.counters.smallest_dt = longest_step(model_.settings);
}

/// Appends a batch and bonds its particles with each other. Bonds do not cross the outlines of
/// `areas`; null: no bonds.
void SolverImpl::append(State& state, const ParticleBatch& batch, const std::vector<Area>* areas,
                        const StopRequest& stop) const {
  check_batch(batch, 1);
  Particles& p = state.particles;
  const std::size_t old = p.size();
  const Terrain& terrain = present_terrain(model_, state);
  const double fresh_mass = nominal_particle_mass(model_.settings, model_.terrain.cell());
  p.resize(old + batch.positions.size());
  for (std::size_t k = 0; k < batch.positions.size(); ++k) {
    const Vec3& x = batch.positions[k];
    const geometry::CellPosition position = terrain.cell_position(x.x(), x.y());
    if (!position.inside() || std::isnan(terrain.height(position)))
      throw SimulationError("a particle at (" + std::to_string(x.x()) + ", " +
                            std::to_string(x.y()) + ") m lies outside of the terrain");
    const std::size_t i = old + k;
    const Vec3 u = batch.fall_speed > 0 ? Vec3(batch.fall_speed * fall_line(terrain, position))
                                        : batch.velocity;
    p.x[i] = x.x();
    p.y[i] = x.y();
    p.z[i] = terrain.height(position);
    p.ux[i] = u.x();
    p.uy[i] = u.y();
    p.uz[i] = u.z();
    p.mass[i] = batch.mass_of(k);
    p.fresh_mass[i] = model_.compatible() ? fresh_mass : p.mass[i];
    p.id[i] = state.next_id++;
    p.event[i] = std::uint16_t(batch.event);
    if (p.tracks_rest) p.rest[i] = 0;
  }
  if (!areas) return;
  // Compatible mode has bonds across gaps of the release.
  const Bonds bonds =
      bonds_between(p, old, lattice_spacing(batch), model_.compatible() ? nullptr : areas, stop);
  state.bonds.reserve(state.bonds.size() + bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b)
    state.bonds.add(bonds.first[b], bonds.second[b], bonds.rest_length[b]);
  state.bonds_made += std::int64_t(bonds.size());
}

/// Appends the snow of the releases with this trigger that are due. Those of the compatible mode
/// have no bonds, so that nothing is allocated if there is memory for the particles.
void SolverImpl::append_due(State& state, Trigger trigger) const {
  for (std::size_t i = 0; i < model_.late.size(); ++i) {
    const LateRelease& late = model_.late[i];
    if (state.late[i] != due || late.trigger != trigger) continue;
    const std::vector<Area> own = late.bonds ? std::vector<Area>{late.area} : std::vector<Area>();
    append(state, late.snow, late.bonds ? &own : nullptr, {});
    const double mass = late.snow.total_mass();
    (trigger == Trigger::contact ? state.balance.secondary : state.balance.inflow) += mass;
    state.late[i] = state.time;
  }
}

/// Adds the snow that is due before a step; in the compatible mode only that of inflows. The state
/// and its workspace change together, or not at all. Returns whether snow was added.
bool SolverImpl::release_before_step() {
  if (model_.late.empty()) return false;
  const std::vector<double> marked = with_timed_marked(model_, state_);
  const bool compatible = model_.compatible();
  if (!any_due(model_, marked, Trigger::time) &&
      (compatible || !any_due(model_, marked, Trigger::contact)))
    return false;
  State next = state_;
  next.late = marked;
  if (compatible) refuse_snow_in_inflows(model_, next);
  append_due(next, Trigger::time);
  if (!compatible) append_due(next, Trigger::contact);
  if (!compatible) next.peak_kinetic = 0;  // the later snow may be faster or slower
  Workspace work;
  refresh(model_, next, work, &next.peaks);
  choose_step(next, work);
  count_as_added(next, work, next.energy);
  work.reserve_memory(model_, next);
  state_ = std::move(next);
  workspace_ = std::move(work);
  order_.forget();
  return true;
}

/// Compatible mode: adds the snow of secondary releases at the end of a step, before the fields
/// are computed. `reserve_memory` has provided for it.
void SolverImpl::release_in_step() {
  if (!model_.compatible() || !any_due(model_, state_.late, Trigger::contact)) return;
  const std::size_t old = size();
  append_due(state_, Trigger::contact);
  for (std::size_t i = old; i < size(); ++i)
    state_.energy.added += state_.particles.mass[i] * model_.gravity * state_.particles.z[i];
  workspace_.cell_positions.resize(size());
  refresh_cell_positions(model_, state_, workspace_, old, size());
  workspace_.bond_lists.update(state_.bonds, size());
}

/// Shortens the steps for the bonds. With these steps snow may pile up to four times its thickness
/// before bonds become too stiff. Compatible mode keeps the given step.
void SolverImpl::choose_step(State& next, const Workspace& work) const {
  const Settings& s = model_.settings;
  if (model_.compatible()) return;
  const double max_step = 0.5 * max_bond_step(next.bonds, next.particles, work.thickness,
                                              s.bond_modulus, model_.thins_bonds());
  const double parts = std::ceil(s.time_step / max_step);
  if (parts > max_substeps)
    throw InputError("/numerics/time_step",
                     show_rounded(s.time_step) + " s; bonds with a modulus of " +
                         show_rounded(s.bond_modulus) + " Pa need steps of at most " +
                         show_rounded(max_step) + " s; at most " + show_rounded(max_substeps) +
                         " are taken in place of one");
  next.step = std::min(longest_step(s), s.time_step / std::max(1.0, parts));
  next.counters.smallest_dt = std::min(next.counters.smallest_dt, next.step);
}

/// Counts the difference of the next state's energy from the present one as added.
void SolverImpl::count_as_added(const State& next, const Workspace& work,
                                EnergyBalance& sums) const {
  if (!model_.keeps_energy) return;
  EnergyBalance before, after;
  store_energy(model_, state_, workspace_, before);
  store_energy(model_, next, work, after);
  sums.added += after.stored() - before.stored();
}

/// Takes over a state and updates the workspace.
void SolverImpl::accept(State next) {
  Workspace work;
  refresh(model_, next, work, &next.peaks);
  choose_step(next, work);
  mark_contacts(model_, next, work);
  count_as_added(next, work, next.energy);
  state_ = std::move(next);
  workspace_ = std::move(work);
  order_.forget();
}

/// Appends the snow that an event begins with.
void SolverImpl::append_all(State& state, const std::vector<ParticleBatch>& batches,
                            const StopRequest& stop) const {
  for (const ParticleBatch& batch : batches) {
    append(state, batch, model_.settings.bonds ? &model_.areas.release : nullptr, stop);
    state.balance.released += compensated_sum(
        state.particles.mass.data() + (state.particles.size() - batch.positions.size()),
        batch.positions.size());
  }
}

void SolverImpl::add(const std::vector<ParticleBatch>& batches, const StopRequest& stop) {
  soundness_.require();
  State next = state_;
  append_all(next, batches, stop);
  next.stopped = false;
  next.peak_kinetic = 0;
  accept(std::move(next));
}

void SolverImpl::replace(const std::vector<ParticleBatch>& batches) {
  soundness_.require();
  State next(model_);
  next.time = state_.time;
  next.counters = state_.counters;
  next.sorts = state_.sorts;
  next.next_id = state_.next_id;
  next.peaks = state_.peaks;
  next.erodible = state_.erodible;
  next.ground = state_.ground;
  next.late = state_.late;
  next.over_dams = state_.over_dams;
  next.forest = state_.forest;
  next.energy = state_.energy;
  append_all(next, batches, {});
  accept(std::move(next));
}

void SolverImpl::add_velocity(const std::vector<Vec3>& changes) {
  soundness_.require();
  State next = state_;
  check_velocity_changes(changes, size());
  const std::vector<std::uint32_t>& at = order_by_id();
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Vec3 n = workspace_.cell_positions.normal(at[k]);
    const Vec3 along = changes[k] - changes[k].dot(n) * n;  // snow stays on the ground
    next.particles.ux[at[k]] += along.x();
    next.particles.uy[at[k]] += along.y();
    next.particles.uz[at[k]] += along.z();
  }
  next.stopped = false;
  accept(std::move(next));
}

/// Sorts the particles by cells from time to time, because they then find their neighbours faster.
/// Changes nothing if it throws; the workspace has the memory for the refresh.
void SolverImpl::sort_if_due() {
  if (state_.counters.steps % steps_between_sorts != 0) return;
  if (std::is_sorted(workspace_.cells.order().begin(), workspace_.cells.order().end())) return;
  sort_by_cell(state_, workspace_);
  refresh(model_, state_, workspace_);
  order_.forget();
  ++state_.sorts;
}

/// Keeps the positions before a step: dams act on the paths of particles, and in the compatible
/// mode snow that stops becomes ground where it was.
void SolverImpl::keep_positions() {
  const Particles& p = state_.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    workspace_.positions_before[i] = {p.x[i], p.y[i], p.z[i]};
}

void SolverImpl::choose_threads() {
  const int max_threads = model_.threads_for(size());
  const bool by_trial = size() < particles_for_threads;
  workspace_.threads = by_trial ? workspace_.thread_choice.begin(max_threads) : max_threads;
}

void SolverImpl::step() {
  soundness_.require();
  const bool awaits_snow = !model_.compatible() && awaits_time(model_, state_);
  if (size() == 0 && !awaits_snow) throw SimulationError("there is no snow on the terrain");
  if (!release_before_step()) {
    workspace_.reserve_memory(model_, state_);
    sort_if_due();
  }
  if (state_.ground && slide::adapt_ground(model_, state_, workspace_)) order_.forget();
  choose_threads();
  // Nothing from here on allocates.
  const bool keeps_energy = model_.keeps_energy;
  EnergyRecorder& recorder = workspace_.energy_recorder;
  if (keeps_energy) recorder.begin_step(state_);
  apply_ground(model_, state_, workspace_);
  if (keeps_energy) recorder.after_ground(model_, state_, workspace_, state_.energy);
  apply_neighbours(model_, state_, workspace_);
  if (model_.keeps_positions()) keep_positions();
  slide::advance(model_, state_, workspace_);
  const bool follows_avaframe = state_.ground && model_.compatible();
  if (follows_avaframe && model_.settings.ground_gains_stopped)
    mark_stopped(model_, state_, workspace_);
  if (keeps_energy) recorder.after_motion(model_, state_, workspace_, state_.energy);
  mark_detrained(model_, state_, workspace_);
  if (!model_.dams.empty()) apply_dams(model_, state_, workspace_);
  find_stop(model_, state_);
  remove_broken(state_, workspace_);
  remove_marked(state_, workspace_);
  split_heavy(model_, state_, workspace_);
  release_in_step();
  refresh_fields(model_, state_, workspace_, &state_.peaks);
  if (follows_avaframe) take_changes_of_step(model_, state_, workspace_);
  state_.dt = state_.step;
  count_rest(state_);
  ++state_.counters.steps;
  const bool step_is_constant = state_.counters.smallest_dt == longest_step(model_.settings);
  state_.time =
      step_is_constant ? double(state_.counters.steps) * state_.dt : state_.time + state_.dt;
  state_.counters.particle_updates += std::int64_t(size());
  order_.forget();
  workspace_.thread_choice.end();
  if (size() == 0) state_.stopped = true;
  mark_contacts(model_, state_, workspace_);
  // In the compatible mode the slide stops without the snow to come, as in AvaFrame.
  if (!model_.compatible() &&
      (any_due(model_, state_.late, Trigger::contact) || awaits_time(model_, state_)))
    state_.stopped = false;
  if (!std::isfinite(state_.kinetic_energy)) {
    soundness_.lose();
    soundness_.fail("a particle is not finite after " + std::to_string(state_.time) + " s");
  }
}

}  // namespace snowshed::methods::slide
