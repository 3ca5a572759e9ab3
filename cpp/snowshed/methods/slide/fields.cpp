// What a slide tells of its particles.
#include <cmath>

#include "snowshed/methods/slide/solver_impl.hpp"
#include "snowshed/particles/field_sources.hpp"

namespace snowshed {

double SlideSolver::speed(std::size_t i) const {
  const SlideParticles& p = state_.particles;
  return std::sqrt(p.ux[i] * p.ux[i] + p.uy[i] * p.uy[i] + p.uz[i] * p.uz[i]);
}

/// Calls visit(info, view) for each field; view() returns its view.
template <class Visit>
void SlideSolver::visit_fields(Visit visit) const {
  const SlideParticles& p = state_.particles;
  const auto stored = [&](const FieldInfo& info, const auto& array) {
    visit(info, [&] { return stored_view(info, array); });
  };
  const auto column = [&](const char* name, const auto& array) {
    stored(field_of(quantity(name), field_type<std::decay_t<decltype(array[0])>>(), true), array);
  };
  const auto component = [&](const char* axis, const auto& array) {
    const Quantity& v = quantity("velocity");
    stored({v.name + "_" + axis, v.unit, v.meaning + "; component " + axis, 1, FieldType::float64,
            true},
           array);
  };
  const auto of_each = [&](const char* name, auto value) {
    const FieldInfo info = field_of(quantity(name), FieldType::float64, false);
    visit(info, [&] { return computed_view(info, values_of_each(size(), model_.threads, value)); });
  };
  of_each("position", [&p](std::size_t i) { return Vec3(p.x[i], p.y[i], p.z[i]); });
  of_each("velocity", [&p](std::size_t i) { return Vec3(p.ux[i], p.uy[i], p.uz[i]); });
  component("x", p.ux);
  component("y", p.uy);
  component("z", p.uz);
  column("mass", p.mass);
  column("thickness", work_.thickness);
  column("id", p.id);
  column("event", p.event);
}

std::vector<FieldInfo> SlideSolver::fields() const {
  return listed_fields([this](const auto& visit) { visit_fields(visit); });
}

FieldView SlideSolver::field(const std::string& name) const {
  return found_field(name, [this](const auto& visit) { visit_fields(visit); });
}

ParticleState SlideSolver::state() const {
  const SlideParticles& p = state_.particles;
  ParticleState s;
  s.positions.reserve(size());
  s.velocities.reserve(size());
  s.volume_ratios.assign(size(), 1.0);
  s.plastic_strains.assign(size(), 0.0);
  s.densities.assign(size(), model_.settings.density);
  for (auto* values : {&s.masses, &s.pressures}) values->reserve(size());
  s.ids.reserve(size());
  s.events.reserve(size());
  for (const std::uint32_t i : order_by_id()) {
    s.positions.push_back({p.x[i], p.y[i], p.z[i]});
    s.velocities.push_back({p.ux[i], p.uy[i], p.uz[i]});
    s.masses.push_back(p.mass[i]);
    // Hydrostatic, at the base.
    s.pressures.push_back(model_.settings.density * model_.gravity * work_.places.nz[i] *
                          work_.thickness[i]);
    s.ids.push_back(p.id[i]);
    s.events.push_back(p.event[i]);
  }
  return s;
}

NamedEnergies SlideSolver::energy_table() const {
  SlideEnergy energy = state_.energy;
  if (model_.keeps_energy) store_energy(model_, state_, work_, energy);
  return named_energies(energy);
}

MotionSummary SlideSolver::motion(double limit) const {
  MotionSummary m;
  double twice_kinetic = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double v = speed(i), mass = state_.particles.mass[i];
    m.mass += mass;
    twice_kinetic += mass * v * v;
    if (v > limit) m.moving_mass += mass;
  }
  m.rms_speed = m.mass > 0 ? std::sqrt(twice_kinetic / m.mass) : 0;
  return m;
}

std::size_t SlideSolver::bytes() const {
  std::size_t total = model_.terrain.bytes() + work_.cells.bytes() + work_.fields.bytes() +
                      work_.bond_lists.bytes();
  state_.particles.for_each_array(
      [&total](const char*, const auto& array) { total += array.capacity() * sizeof(array[0]); });
  const auto count = [&total](const auto& vector) {
    total += vector.capacity() * sizeof(vector[0]);
  };
  count(state_.bonds.first);
  count(state_.bonds.second);
  count(state_.bonds.rest_length);
  count(state_.peaks.thickness);
  count(state_.peaks.speed);
  count(state_.erodible);
  count(work_.thickness);
  count(work_.predicted);
  count(work_.pushed);
  count(work_.sorted_pressing);
  count(work_.bond_force);
  const SlideLoads& l = work_.loads;
  for (const auto* array : {&l.ax, &l.ay, &l.az, &l.yield, &l.drag, &l.speed}) count(*array);
  Places::for_each_array(work_.places, count);
  return total;
}

}  // namespace snowshed
