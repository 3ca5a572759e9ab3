#include "snowshed/particles/quantities.hpp"

#include <stdexcept>

namespace snowshed {

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all{
      {"position", "m", "Position", 3},
      {"velocity", "m/s", "Velocity", 3},
      {"speed", "m/s", "Speed", 1, 0.05},
      {"angular_velocity", "rad/s", "Angular velocity", 3},
      {"mass", "kg", "Mass; in 2D per metre of width"},
      {"density", "kg/m3", "Current density", 1, 1.0},
      {"volume_ratio", "1", "Current over initial volume"},
      {"equivalent_radius", "m", "Radius of the sphere with a grain's volume"},
      {"coordination", "1", "Number of grains that a grain touches", 1, 1.0},
      {"thickness", "m", "Thickness of the snow, normal to the ground", 1, 0.005},
      {"pressure", "Pa", "Kirchhoff pressure, positive in compression", 1, 100.0},
      // Without a step, as below: a film does not keep them, which would be larger by half.
      {"deviatoric_stress", "Pa", "Deviatoric stress, von Mises equivalent of Kirchhoff's"},
      {"preconsolidation_pressure", "Pa",
       "Preconsolidation pressure, hardened or softened; 0: none, or elastic snow"},
      {"number_density", "1", "Number density of particles over that of a lattice", 1, 0.01},
      {"shear_rate", "1/s", "Shear rate, the root of 2 D:D"},
      {"apparent_viscosity", "Pa s", "Shear stress over shear rate"},
      {"particle_kind", "1", "0: moving, 1: erodible, 2: inner wall, 3: dummy wall", 1, 1.0},
      {"volumetric_plastic_strain", "1",
       "Volumetric plastic strain, logarithmic, negative in compaction", 1, 0.01},
      {"be_minus_identity", "1", "Elastic left Cauchy-Green tensor less the identity"},
      {"affine", "1/s", "Affine velocity matrix C of APIC, by rows", 9},
      {"id", "1", "Number that a particle keeps as long as it exists"},
      {"event", "1", "Event in which the particle was released, from 1"},
      {"material_id", "1", "Which of the scene's snows the particle is of, from 0"},
  };
  return all;
}

const Quantity& quantity(const std::string& name) {
  for (const Quantity& one : quantities())
    if (one.name == name) return one;
  throw std::out_of_range("no quantity " + name);
}

}  // namespace snowshed
