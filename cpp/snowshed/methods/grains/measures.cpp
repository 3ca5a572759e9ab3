// Measurements of a loading test, the contacts between grains, and the fields of their spheres.
#include <algorithm>

#include "snowshed/methods/grains/contacts.hpp"
#include "snowshed/methods/grains/cost.hpp"
#include "snowshed/methods/grains/loading_curve.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"

namespace snowshed::methods::grains {

LoadingStresses SolverImpl::stresses() const {
  const Boundary& b = state_.boundary;
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

/// Approach of the plates since the beginning, m.
double SolverImpl::shortened_by() const {
  const Boundary& b = state_.boundary;
  const double r = model_.radius;
  return (model_.box.z() + r - b.plate[1].z()) + (b.plate[0].z() + r);
}

LoadingMeasures SolverImpl::measures() const {
  const Boundary& b = state_.boundary;
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

std::vector<GrainContact> SolverImpl::grain_contacts() const {
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

std::optional<double> SolverImpl::progress() const {
  return loading_progress(model_.loading, state_.loading.stage,
                          state_.loading.displacement / model_.box.z());
}

std::unique_ptr<Curve> SolverImpl::empty_curve() const {
  return std::make_unique<LoadingCurve>(model_.loading, model_.box.z(),
                                        model_.keeps_energy ? energies() : NamedEnergies{});
}

/// The spheres, with fields of their grains: number, velocity, numbers of touching and of bonded
/// grains, and half the sum of the contact forces.
PointCloud SolverImpl::snapshot() const {
  const std::vector<std::uint32_t>& of = model_.spheres.grain;
  std::vector<std::int32_t> touching(size(), 0), bonded(size(), 0);
  std::vector<float> force(size(), 0);
  for (const GrainContact& contact : grain_contacts())
    for (const std::uint32_t grain : {contact.first, contact.second}) {
      ++touching[grain];
      bonded[grain] += contact.bonded;
      force[grain] += 0.5f * float(contact.force.norm());
    }
  const std::vector<Vec3> positions = sphere_positions();
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < positions.size(); ++i)
    velocities.push_back(state_.bodies[of[i]].velocity);
  PointCloud cloud = PointCloud::moving(positions, velocities);
  const auto add = [&](const char* name, const auto& of_grains) {
    std::decay_t<decltype(of_grains)> each;
    for (std::size_t i = 0; i < positions.size(); ++i) each.push_back(of_grains[of[i]]);
    cloud.arrays.push_back({name, 1, std::move(each)});
  };
  cloud.add<std::int32_t>("grain", of);
  add("touching_grains", touching);
  add("bonded_grains", bonded);
  add("contact_force", force);
  return cloud;
}

std::vector<Vec3> SolverImpl::sphere_positions() const {
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

}  // namespace snowshed::methods::grains
