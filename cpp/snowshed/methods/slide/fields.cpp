// Fields of the particles of a slide.
#include <cmath>

#include "snowshed/core/compensated_sum.hpp"
#include "snowshed/methods/field_sources.hpp"
#include "snowshed/methods/slide/solver_impl.hpp"

namespace snowshed::methods::slide {

/// Calls visit(info, view) for each field; view() returns its view.
template <class Visit>
void SolverImpl::visit_fields(Visit visit) const {
  const Particles& p = state_.particles;
  const FieldSources show(visit, size(), model_.threads);
  const auto component = [&](const char* axis, const auto& array) {
    const Quantity& v = quantity("velocity");
    show.stored({v.name + "_" + axis, v.unit, v.meaning + "; component " + axis, 1,
                 particles::FieldType::float64, true},
                array);
  };
  show.of_each("position", [&p](std::size_t i) { return Vec3(p.x[i], p.y[i], p.z[i]); });
  show.of_each("velocity", [&p](std::size_t i) { return Vec3(p.ux[i], p.uy[i], p.uz[i]); });
  component("x", p.ux);
  component("y", p.uy);
  component("z", p.uz);
  show.column("mass", p.mass);
  show.column("thickness", workspace_.thickness);
  show.column("id", p.id);
  show.column("event", p.event);
}

std::vector<particles::FieldInfo> SolverImpl::fields() const {
  return list_fields([this](const auto& visit) { visit_fields(visit); });
}

particles::FieldView SolverImpl::field(const std::string& name) const {
  return find_field(name, [this](const auto& visit) { visit_fields(visit); });
}

ParticleState SolverImpl::state() const {
  const Particles& p = state_.particles;
  ParticleState s;
  s.positions.reserve(size());
  s.velocities.reserve(size());
  s.densities.assign(size(), model_.settings.density);
  s.masses.reserve(size());
  s.ids.reserve(size());
  s.events.reserve(size());
  for (const std::uint32_t i : order_by_id()) {
    s.positions.push_back({p.x[i], p.y[i], p.z[i]});
    s.velocities.push_back({p.ux[i], p.uy[i], p.uz[i]});
    s.masses.push_back(p.mass[i]);
    s.ids.push_back(p.id[i]);
    s.events.push_back(p.event[i]);
  }
  return s;
}

/// Adds thickness, speed and number of bonds of each particle, and the bonds as lines. The pressure
/// is the hydrostatic pressure at the base.
PointCloud SolverImpl::snapshot() const {
  PointCloud cloud = Method::snapshot();
  const std::vector<std::uint32_t>& order = order_by_id();
  const Particles& p = state_.particles;
  std::vector<std::uint32_t> index_in_cloud(order.size());
  std::vector<float> pressure, thickness, speed;
  pressure.reserve(order.size());
  thickness.reserve(order.size());
  speed.reserve(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    index_in_cloud[i] = k;
    pressure.push_back(float(model_.settings.density * model_.gravity *
                             workspace_.cell_positions.nz[i] * workspace_.thickness[i]));
    thickness.push_back(float(workspace_.thickness[i]));
    speed.push_back(float(Vec3(p.ux[i], p.uy[i], p.uz[i]).norm()));
  }
  std::vector<std::int32_t> count(order.size(), 0);
  const Bonds& bonds = state_.bonds;
  cloud.lines.reserve(bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    cloud.lines.push_back({index_in_cloud[bonds.first[b]], index_in_cloud[bonds.second[b]]});
    for (const std::uint32_t particle : cloud.lines.back()) ++count[particle];
  }
  cloud.replace("pressure", std::move(pressure));
  cloud.arrays.push_back({"thickness", 1, std::move(thickness)});
  cloud.arrays.push_back({"speed", 1, std::move(speed)});
  cloud.arrays.push_back({"bonds", 1, std::move(count)});
  return cloud;
}

/// The mass balance. Its residual consists of rounding errors only.
ReportsRun::Section SolverImpl::run_section() const {
  const MassBalance& m = state_.balance;
  const double on_terrain = compensated_sum(state_.particles.mass.data(), size());
  Section section{"mass_balance", {{"released_kg", m.released}}};
  const auto report = [&](bool is_used, const char* name, double mass) {
    if (is_used) section.facts.push_back({name, mass});
  };
  report(!model_.areas.secondary_release.empty(), "secondary_release_kg", m.secondary);
  report(!model_.areas.inflows.empty(), "inflow_kg", m.inflow);
  report(true, "entrained_kg", m.entrained);
  report(model_.detrains(), "detrained_kg", m.detrained);
  report(model_.settings.ground_gains_stopped, "stopped_kg", m.stopped);
  report(true, "left_terrain_kg", m.left_terrain);
  report(true, "on_terrain_kg", on_terrain);
  report(true, "residual_kg",
         m.released + m.secondary + m.inflow + m.entrained - m.detrained - m.stopped -
             m.left_terrain - on_terrain);
  if (state_.ground) section.facts.push_back({"ground_gained_m3", state_.ground->volume()});
  return section;
}

std::vector<DamFact> SolverImpl::dams() const {
  std::vector<DamFact> facts;
  for (std::size_t i = 0; i < model_.dams.size(); ++i)
    facts.push_back({model_.areas.dams[i].name, state_.over_dams[i]});
  return facts;
}

std::vector<LateReleaseFact> SolverImpl::late_releases() const {
  std::vector<LateReleaseFact> facts;
  for (std::size_t i = 0; i < model_.late.size(); ++i) {
    const LateRelease& late = model_.late[i];
    facts.push_back({late.area.name, late.trigger, late.time,
                     state_.late[i] < 0 ? waiting : state_.late[i], late.snow.total_mass()});
  }
  return facts;
}

NamedEnergies SolverImpl::energies() const {
  EnergyBalance energy = state_.energy;
  if (model_.keeps_energy) store_energy(model_, state_, workspace_, energy);
  return named_energies(energy);
}

MotionSummary SolverImpl::motion(double limit) const {
  const Particles& p = state_.particles;
  return motion_of(
      size(), limit, [&p](std::size_t i) { return p.mass[i]; },
      [&p](std::size_t i) { return Vec3(p.ux[i], p.uy[i], p.uz[i]).squaredNorm(); });
}

std::size_t SolverImpl::bytes() const {
  std::size_t total = model_.terrain.bytes() + workspace_.cells.bytes() +
                      workspace_.fields.bytes() + workspace_.bond_lists.bytes();
  state_.particles.for_each_array(
      [&total](const char*, const auto& array) { total += bytes_of(array); });
  const Bonds& bonds = state_.bonds;
  total += bytes_of(bonds.first, bonds.second, bonds.rest_length, state_.peaks.thickness,
                    state_.peaks.speed, state_.erodible, workspace_.thickness, workspace_.predicted,
                    workspace_.pressure_force, workspace_.sorted_pressure_factor,
                    workspace_.sorted_column_mass, workspace_.bond_force);
  if (state_.ground) total += state_.ground->bytes();
  const Loads& l = workspace_.loads;
  total += bytes_of(l.ax, l.ay, l.az, l.coulomb_deceleration, l.drag, l.speed);
  CellPositions::for_each_array(workspace_.cell_positions,
                                [&](const auto& array) { total += bytes_of(array); });
  return total;
}

}  // namespace snowshed::methods::slide
