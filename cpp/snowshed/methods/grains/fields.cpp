// Fields of the solver of grains.
#include <cmath>

#include "snowshed/core/angles.hpp"
#include "snowshed/methods/field_sources.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"

namespace snowshed::methods::grains {

/// Calls visit(info, view) for each field; view() returns its view.
template <class Visit>
void SolverImpl::visit_fields(Visit visit) const {
  const FieldSources show(visit, size(), model_.threads);
  show.of_each("position", [this](std::size_t i) { return state_.bodies[i].position; });
  show.of_each("velocity", [this](std::size_t i) { return state_.bodies[i].velocity; });
  show.of_each("angular_velocity", [this](std::size_t i) {
    const GrainBody& body = state_.bodies[i];
    return angular_velocity(body.orientation.toRotationMatrix(), body.spin_momentum,
                            model_.grains[i].inertia);
  });
  show.of_each("mass",
               [this](std::size_t i) { return model_.settings.density * model_.grains[i].volume; });
  show.of_each("equivalent_radius",
               [this](std::size_t i) { return std::cbrt(0.75 / pi * model_.grains[i].volume); });
  show.computed("coordination", [&] {
    std::vector<std::uint32_t> contacts(size());
    for (const GrainContact& contact : grain_contacts()) {
      ++contacts[contact.first];
      ++contacts[contact.second];
    }
    return contacts;
  });
  show.computed("id", [&] {
    std::vector<std::uint32_t> ids(size());
    for (std::size_t i = 0; i < size(); ++i) ids[i] = state_.first_id + std::uint32_t(i);
    return ids;
  });
  show.computed("event", [&] { return state_.events; });
}

std::vector<particles::FieldInfo> SolverImpl::fields() const {
  return list_fields([this](const auto& visit) { visit_fields(visit); });
}

particles::FieldView SolverImpl::field(const std::string& name) const {
  return find_field(name, [this](const auto& visit) { visit_fields(visit); });
}

ParticleState SolverImpl::state() const {
  ParticleState s;
  for (std::size_t i = 0; i < size(); ++i) {
    s.positions.push_back(state_.bodies[i].position);
    s.velocities.push_back(state_.bodies[i].velocity);
    s.masses.push_back(model_.settings.density * model_.grains[i].volume);
    s.densities.push_back(model_.settings.density);
    s.ids.push_back(state_.first_id + std::uint32_t(i));
    s.events.push_back(state_.events[i]);
  }
  return s;
}

MotionSummary SolverImpl::motion(double limit) const {
  return motion_of(
      size(), limit,
      [this](std::size_t i) { return model_.settings.density * model_.grains[i].volume; },
      [this](std::size_t i) { return state_.bodies[i].velocity.squaredNorm(); });
}

NamedEnergies SolverImpl::energies() const {
  if (!model_.keeps_energy) return named_energies(EnergyBalance{});
  EnergyBalance energy = state_.energy;
  store_energy(model_, state_, energy);
  return named_energies(energy);
}

std::size_t SolverImpl::bytes() const {
  return state_.pairs.bytes() +
         bytes_of(model_.grains, model_.spheres.offsets, model_.spheres.grain, model_.bonds,
                  state_.bodies, state_.events, state_.searched_poses, workspace_.next,
                  workspace_.frames, workspace_.results, workspace_.groups_by_body.begin,
                  workspace_.groups_by_body.entry, workspace_.damped_energy, order_);
}

}  // namespace snowshed::methods::grains
