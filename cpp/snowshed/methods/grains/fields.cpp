// What the solver tells of its grains.
#include <cmath>

#include "snowshed/methods/grains/solver_impl.hpp"
#include "snowshed/particles/field_sources.hpp"

namespace snowshed {

/// Calls visit(info, view) for each field; view() returns its view.
template <class Visit>
void GrainsSolver::visit_fields(Visit visit) const {
  const auto of_each = [&](const char* name, auto value) {
    const FieldInfo info = field_of(quantity(name), FieldType::float64, false);
    visit(info, [&] { return computed_view(info, values_of_each(size(), model_.threads, value)); });
  };
  of_each("position", [this](std::size_t i) { return state_.bodies[i].position; });
  of_each("velocity", [this](std::size_t i) { return state_.bodies[i].velocity; });
  of_each("angular_velocity", [this](std::size_t i) {
    const GrainBody& body = state_.bodies[i];
    return angular_velocity(body.orientation.toRotationMatrix(), body.spin_momentum,
                            model_.grains[i].inertia);
  });
  of_each("mass",
          [this](std::size_t i) { return model_.settings.density * model_.grains[i].volume; });
  of_each("equivalent_radius", [this](std::size_t i) {
    return std::cbrt(0.75 / 3.14159265358979323846 * model_.grains[i].volume);
  });
  const FieldInfo touched = field_of(quantity("coordination"), FieldType::uint32, false);
  visit(touched, [&] {
    std::vector<std::uint32_t> contacts(size());
    for (const GrainContact& contact : grain_contacts()) {
      ++contacts[contact.first];
      ++contacts[contact.second];
    }
    return computed_view(touched, std::move(contacts));
  });
  const FieldInfo id = field_of(quantity("id"), FieldType::uint32, false);
  visit(id, [&] {
    std::vector<std::uint32_t> ids(size());
    for (std::size_t i = 0; i < size(); ++i) ids[i] = state_.first_id + std::uint32_t(i);
    return computed_view(id, std::move(ids));
  });
  const FieldInfo event = field_of(quantity("event"), FieldType::uint16, false);
  visit(event, [&] { return computed_view(event, state_.events); });
}

std::vector<FieldInfo> GrainsSolver::fields() const {
  return listed_fields([this](const auto& visit) { visit_fields(visit); });
}

FieldView GrainsSolver::field(const std::string& name) const {
  return found_field(name, [this](const auto& visit) { visit_fields(visit); });
}

ParticleState GrainsSolver::state() const {
  ParticleState s;
  for (std::size_t i = 0; i < size(); ++i) {
    s.positions.push_back(state_.bodies[i].position);
    s.velocities.push_back(state_.bodies[i].velocity);
    s.masses.push_back(model_.settings.density * model_.grains[i].volume);
    s.volume_ratios.push_back(1.0);
    s.densities.push_back(model_.settings.density);
    s.plastic_strains.push_back(0.0);
    s.pressures.push_back(0.0);
    s.ids.push_back(state_.first_id + std::uint32_t(i));
    s.events.push_back(state_.events[i]);
  }
  return s;
}

MotionSummary GrainsSolver::motion(double limit) const {
  MotionSummary m;
  double twice_kinetic = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double mass = model_.settings.density * model_.grains[i].volume;
    const double square = state_.bodies[i].velocity.squaredNorm();
    m.mass += mass;
    twice_kinetic += mass * square;
    if (square > limit * limit) m.moving_mass += mass;
  }
  m.rms_speed = m.mass > 0 ? std::sqrt(twice_kinetic / m.mass) : 0;
  return m;
}

NamedEnergies GrainsSolver::energy_table() const {
  if (!model_.keeps_energy) return named_energies(GrainsEnergy{});
  GrainsEnergy energy = state_.energy;
  store_energy(model_, state_, energy);
  return named_energies(energy);
}

std::size_t GrainsSolver::bytes() const {
  std::size_t total = state_.pairs.bytes();
  const auto count = [&total](const auto& vector) {
    total += vector.capacity() * sizeof(vector[0]);
  };
  count(model_.grains);
  count(model_.spheres.offsets);
  count(model_.spheres.grain);
  count(model_.bonds);
  count(state_.bodies);
  count(state_.events);
  count(state_.listed);
  count(work_.next);
  count(work_.frames);
  count(work_.results);
  count(work_.groups_of.begin);
  count(work_.groups_of.entry);
  count(work_.damped);
  count(order_);
  return total;
}

}  // namespace snowshed
