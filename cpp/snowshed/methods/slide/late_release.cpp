#include "snowshed/methods/slide/late_release.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/methods/slide/release.hpp"
#include "snowshed/methods/slide/state.hpp"

namespace snowshed::methods::slide {
namespace {

constexpr double time_tolerance = 1e-5;  // s, as in AvaFrame

std::string path_of(const char* list, std::size_t i) {
  return std::string("/terrain/") + list + "/" + std::to_string(i);
}

/// Thickness at the nodes of a secondary release; AvaFrame leaves out the nodes of the release.
std::vector<double> thickness_beside_release(const Area& area, const Areas& areas,
                                             const Terrain& terrain) {
  std::vector<double> values = thickness_at_nodes({area}, terrain, Reach::one_cell);
  const std::vector<double> released = released_at_nodes(areas.release, terrain, Mode::compatible);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (released[i] > 0) values[i] = 0;
  return values;
}

LateRelease secondary_release(const Settings& s, const Terrain& terrain, const Areas& areas,
                              std::size_t index) {
  const Area& area = areas.secondary_release[index];
  const std::string where = path_of("secondary_release", index);
  LateRelease late{Trigger::contact, 0, area, {}, {}, s.bonds && s.mode == Mode::improved};
  if (s.mode == Mode::compatible) {
    const std::vector<double> thickness = thickness_beside_release(area, areas, terrain);
    for (std::size_t i = 0; i < thickness.size(); ++i)
      if (thickness[i] > 0) late.nodes.push_back(i);
    late.snow = seed_nodes(s, terrain, {area}, thickness, where);
  } else {
    late.snow = seed_polygon(s, terrain, area, where);
  }
  return late;
}

/// Throws if the snow of an inflow must move down level ground.
void check_slope(const Terrain& terrain, const ParticleBatch& snow, const std::string& where) {
  if (snow.fall_speed == 0) return;
  for (const Vec3& x : snow.positions)
    if (terrain.normal(terrain.cell_position(x.x(), x.y())).z() > 1 - 1e-9)
      throw InputError(where, "the ground is level at (" + show_rounded(terrain.west() + x.x()) +
                                  ", " + show_rounded(terrain.south() + x.y()) +
                                  "), so that a speed down the slope has no direction");
}

LateRelease pulse_release(const Settings& s, const Terrain& terrain, const Inflow& inflow,
                          const Pulse& pulse, const std::string& where) {
  LateRelease late{Trigger::time, pulse.time, inflow.area, {}, {}, s.bonds && inflow.bonds};
  late.area.thickness = pulse.thickness;
  late.snow = s.mode == Mode::compatible
                  ? seed_nodes(s, terrain, {late.area},
                               thickness_at_nodes({late.area}, terrain, Reach::one_cell), where)
                  : seed_polygon(s, terrain, late.area, where);
  late.snow.fall_speed = pulse.speed;
  check_slope(terrain, late.snow, where);
  return late;
}

/// Compatible mode: AvaFrame leaves out a pulse that falls between two steps.
void check_times(const Settings& s, const Inflow& inflow, const std::string& where) {
  std::vector<double> times;
  for (const Pulse& pulse : inflow.pulses) {
    if (std::count(times.begin(), times.end(), pulse.time) > 0)
      throw InputError(where, show(pulse.time) + " s occurs twice");
    times.push_back(pulse.time);
    const double steps = pulse.time / s.time_step;
    if (s.mode == Mode::compatible &&
        (pulse.time == 0 || std::abs(steps - std::round(steps)) * s.time_step > time_tolerance))
      throw InputError(where, show(pulse.time) +
                                  " s; the mode \"compatible\" needs multiples of the time step, " +
                                  show(s.time_step) + " s, above 0");
  }
}

bool contains_snow(const LateRelease& late, const Particles& p) {
  const geometry::RingBounds bounds = geometry::bounds_of(late.area.polygon.outline);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const geometry::Point2 x{p.x[i], p.y[i]};
    if (bounds.contain(x) && geometry::contains(late.area.polygon, x)) return true;
  }
  return false;
}

/// Whether snow flows at a node of the release.
bool flows_at_nodes(const LateRelease& late, const GridFields& fields, const Terrain& terrain) {
  return std::any_of(late.nodes.begin(), late.nodes.end(), [&](std::size_t i) {
    return fields.thickness_at(int(i) % terrain.columns(), int(i) / terrain.columns()) > 0;
  });
}

}  // namespace

std::vector<LateRelease> prepare_late_releases(const Settings& s, const Terrain& terrain,
                                               const Areas& areas) {
  std::vector<LateRelease> late;
  std::vector<NamedArea> others = named_areas(areas.release, "release");
  for (std::size_t i = 0; i < areas.secondary_release.size(); ++i) {
    late.push_back(secondary_release(s, terrain, areas, i));
    others.push_back({&areas.secondary_release[i], path_of("secondary_release", i)});
    if (s.mode == Mode::improved)
      refuse_overlap(terrain, others, others.size() - 1, late.back().snow);
  }
  for (std::size_t i = 0; i < areas.inflows.size(); ++i) {
    const Inflow& inflow = areas.inflows[i];
    check_times(s, inflow, path_of("inflows", i) + "/hydrograph");
    for (std::size_t k = 0; k < inflow.pulses.size(); ++k)
      late.push_back(pulse_release(s, terrain, inflow, inflow.pulses[k],
                                   path_of("inflows", i) + "/hydrograph/" + std::to_string(k)));
  }
  return late;
}

std::vector<Area> late_areas(const Areas& areas) {
  std::vector<Area> all = areas.secondary_release;
  for (const Inflow& inflow : areas.inflows)
    for (const Pulse& pulse : inflow.pulses) {
      all.push_back(inflow.area);
      all.back().thickness = pulse.thickness;
    }
  return all;
}

void mark_contacts(const Model& model, State& state, const Workspace& work) {
  for (std::size_t i = 0; i < model.late.size(); ++i) {
    const LateRelease& late = model.late[i];
    if (late.trigger != Trigger::contact || state.late[i] != waiting) continue;
    const bool entered = model.compatible() ? flows_at_nodes(late, work.fields, model.terrain)
                                            : contains_snow(late, state.particles);
    if (entered) state.late[i] = due;
  }
}

std::vector<double> with_timed_marked(const Model& model, const State& state) {
  std::vector<double> marked = state.late;
  const double reached = state.time + (model.compatible() ? state.step : 0) + time_tolerance;
  for (std::size_t i = 0; i < model.late.size(); ++i)
    if (model.late[i].trigger == Trigger::time && marked[i] == waiting &&
        model.late[i].time <= reached)
      marked[i] = due;
  return marked;
}

bool any_due(const Model& model, const std::vector<double>& states, Trigger trigger) {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i] == due && model.late[i].trigger == trigger) return true;
  return false;
}

bool awaits_time(const Model& model, const State& state) {
  for (std::size_t i = 0; i < model.late.size(); ++i)
    if (model.late[i].trigger == Trigger::time && state.late[i] < 0) return true;
  return false;
}

void refuse_snow_in_inflows(const Model& model, const State& state) {
  constexpr double margin = 0.01;  // m, as in AvaFrame
  for (std::size_t i = 0; i < model.late.size(); ++i) {
    const LateRelease& late = model.late[i];
    if (late.trigger != Trigger::time || state.late[i] != due) continue;
    const geometry::Ring ring = widened_as_avaframe(late.area.polygon.outline, margin);
    for (std::size_t k = 0; k < state.particles.size(); ++k)
      if (geometry::contains(ring, {state.particles.x[k], state.particles.y[k]}))
        throw SimulationError("snow still lies in the inflow area \"" + late.area.name + "\" at " +
                              show_rounded(late.time) +
                              " s, where AvaFrame stops, too; choose later times or a higher "
                              "speed, or the mode \"improved\"");
  }
}

std::size_t due_particles(const Model& model, const State& state) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < model.late.size(); ++i)
    if (state.late[i] == due) count += model.late[i].snow.positions.size();
  return count;
}

}  // namespace snowshed::methods::slide
