// What a loading test measures, and the contacts between grains.
#include <algorithm>

#include "snowshed/methods/grains/contacts.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"

namespace snowshed {

LoadingStresses GrainsSolver::stresses() const {
  const GrainsBoundary& b = state_.boundary;
  const double height = model_.box.z();
  LoadingStresses m;
  m.axial_strain = shortened_by() / height;
  m.shear_strain = (b.plate[1].x() - b.plate[0].x()) / height;
  m.top_stress = b.plate_force[1].z() / model_.area();
  m.bottom_stress = -b.plate_force[0].z() / model_.area();
  m.shear_stress = -b.plate_force[1].x() / model_.area();
  const double sides[2] = {model_.box.y() * height, model_.box.x() * height};
  for (int s = 0; s < 4; ++s) m.side_stress += 0.25 * b.side_force[s] / sides[s / 2];
  m.cone_force = b.cone_force.z();
  return m;
}

/// How much nearer the plates are than at the beginning, m.
double GrainsSolver::shortened_by() const {
  const GrainsBoundary& b = state_.boundary;
  const double r = model_.radius;
  return (model_.box.z() + r - b.plate[1].z()) + (b.plate[0].z() + r);
}

LoadingMeasures GrainsSolver::measures() const {
  const GrainsBoundary& b = state_.boundary;
  const double height = model_.box.z();
  LoadingMeasures m{stresses()};
  m.stage = state_.loading.stage;
  m.strain = state_.loading.displacement / height;
  m.bonds = state_.bonds;
  m.broken_in_tension = state_.broken_in_tension;
  m.broken_in_shear = state_.broken_in_shear;
  m.solid_fraction = model_.solid_volume / (b.period(0) * b.period(1) * (height - shortened_by()));
  if (size() == 0) return m;
  for_each_touching(model_, state_,
                    [&](const PairGroup&, std::size_t, const PairGeometry&) { ++m.contacts; });
  m.coordination = 2 * double(grain_contacts().size()) / double(size());
  return m;
}

std::vector<GrainContact> GrainsSolver::grain_contacts() const {
  std::vector<GrainContact> contacts;
  std::vector<double> pairs;
  const PairGroup* last = nullptr;
  for_each_touching(model_, state_,
                    [&](const PairGroup& g, std::size_t p, const PairGeometry& pair) {
                      if (g.second >= size()) return;
                      if (&g != last) {
                        contacts.push_back({g.first, g.second, Vec3::Zero(), Vec3::Zero(), false});
                        pairs.push_back(0);
                        last = &g;
                      }
                      GrainContact& contact = contacts.back();
                      contact.point += state_.bodies[g.first].position + pair.arm_a;
                      contact.force += model_.law.normal_stiffness * pair.gap * pair.normal +
                                       model_.law.shear_stiffness * state_.pairs.shear(p);
                      contact.bonded = contact.bonded || state_.pairs.bonded[p] != 0;
                      ++pairs.back();
                    });
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].point /= pairs[i];
  return contacts;
}

std::vector<Vec3> GrainsSolver::sphere_positions() const {
  std::vector<Vec3> positions;
  if (size() == 0) return positions;
  positions.reserve(count_spheres());
  for (std::size_t i = 0; i < size(); ++i) {
    const Mat3 rotation = state_.bodies[i].orientation.toRotationMatrix();
    const GrainConstants& grain = model_.grains[i];
    for (std::uint32_t s = grain.first_sphere; s < grain.first_sphere + grain.spheres; ++s)
      positions.push_back(state_.bodies[i].position + rotation * model_.spheres.offsets[s]);
  }
  return positions;
}

}  // namespace snowshed
