// The constants of a sample.
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {
namespace {

/// k_n = 2 E r1 r2 / (r1 + r2) with equal radii, and k_s = ratio k_n. The limits are the strengths
/// times the face of a voxel, (2 r)^2. This area is inferred, see docs/methods/grains.md.
BondLaw bond_law(const Settings& s, double radius) {
  const double stiffness = s.elastic_modulus * radius, area = 4 * radius * radius;
  return {stiffness, s.stiffness_ratio * stiffness, s.tensile_strength * area,
          s.shear_strength * area, s.friction};
}

GrainConstants constants_of(const Clump& clump, const Settings& s, double gravity) {
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(clump.inertia);
  Mat3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  GrainConstants grain;
  grain.volume = clump.volume;
  grain.weight = s.density * clump.volume * gravity;
  grain.inertial_mass = s.density * s.density_scaling * clump.volume;
  grain.inertia = s.density * s.density_scaling * principal.eigenvalues();
  grain.initial_position = clump.center;
  grain.initial_orientation = Orientation(axes).normalized();
  grain.first_sphere = clump.first_sphere;
  grain.spheres = clump.spheres;
  grain.reach = 0;
  return grain;
}

}  // namespace

Model::Model(Options o)
    : settings(o.settings),
      gravity(o.gravity),
      loading(std::move(o.loading)),
      cone(o.cone),
      keeps_energy(o.energy),
      threads(threads_to_use(o.settings.threads)),
      radius(o.sample.radius),
      box(o.sample.box),
      bonds(std::move(o.sample.bonds)),
      law(bond_law(o.settings, o.sample.radius)),
      solid_volume(0) {
  spheres.offsets = std::move(o.sample.spheres);
  spheres.grain.resize(spheres.offsets.size());
  grains.reserve(o.sample.clumps.size());
  for (const Clump& clump : o.sample.clumps) {
    GrainConstants grain = constants_of(clump, settings, gravity);
    for (std::uint32_t s = grain.first_sphere; s < grain.first_sphere + grain.spheres; ++s) {
      Vec3& offset = spheres.offsets[s];
      offset = grain.initial_orientation.conjugate() * Vec3(offset - grain.initial_position);
      grain.reach = std::max(grain.reach, offset.norm());
      spheres.grain[s] = std::uint32_t(grains.size());
    }
    solid_volume += grain.volume;
    grains.push_back(grain);
  }
}

}  // namespace snowshed::methods::grains
