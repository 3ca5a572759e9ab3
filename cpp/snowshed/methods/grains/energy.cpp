#include "snowshed/methods/grains/energy.hpp"

#include "snowshed/methods/grains/contacts.hpp"
#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

NamedEnergies named_energies(const EnergyBalance& e) {
  return {{"kinetic_j", e.kinetic},       {"potential_j", e.potential},
          {"elastic_normal_j", e.normal}, {"elastic_shear_j", e.shear},
          {"friction_j", e.friction},     {"damping_j", e.damping},
          {"broken_bonds_j", e.broken},   {"boundary_work_j", e.boundary},
          {"added_j", e.added},           {"residual_j", e.residual()}};
}

double kinetic_energy(const Model& model, const State& state) {
  double twice = 0;
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const GrainBody& body = state.bodies[i];
    const Vec3 l = body.orientation.conjugate() * body.spin_momentum;
    twice += model.grains[i].inertial_mass * body.velocity.squaredNorm() +
             l.dot(l.cwiseQuotient(model.grains[i].inertia));
  }
  return 0.5 * twice;
}

void store_energy(const Model& model, const State& state, EnergyBalance& e) {
  e.kinetic = kinetic_energy(model, state);
  e.potential = e.normal = e.shear = 0;
  for (std::size_t i = 0; i < state.bodies.size(); ++i)
    e.potential += model.grains[i].weight * state.bodies[i].position.z();
  for_each_touching(model, state, [&](const PairGroup&, std::size_t p, const PairGeometry& pair) {
    e.normal += 0.5 * model.law.normal_stiffness * pair.gap * pair.gap;
    e.shear += 0.5 * model.law.shear_stiffness * state.pairs.shear(p).squaredNorm();
  });
}

}  // namespace snowshed::methods::grains
