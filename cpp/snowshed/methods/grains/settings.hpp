// Settings of the discrete elements of snow in a scene.
#pragma once

namespace snowshed::methods::grains {

/// The four vertical sides of a sample: rigid walls without friction, or periodic in x and y.
enum class Sides { walls, periodic };

/// Settings of the grains: rigid clumps of spheres with bonds that break (Hagenmuller, Chambon and
/// Naaim 2015, doi:10.5194/tc-9-1969-2015). We have not seen their table of parameters; the
/// defaults come from other publications, see docs/methods/grains.md.
struct Settings {
  double elastic_modulus = 1e9;   // Pa, E of the contact law
  double stiffness_ratio = 0.3;   // shear over normal stiffness of a contact
  double tensile_strength = 1e6;  // Pa, of bonds
  double shear_strength = 1e6;    // Pa, of bonds
  double friction = 0.2;  // Coulomb coefficient between grains, and between grains and plates
  double density = 917;   // kg/m3, of ice
  // Factor of the grains' inertia, for longer steps; their weight stays.
  double density_scaling = 1;
  double damping = 0.2;         // local, of unbalanced forces
  double courant_factor = 0.3;  // time step relative to the smallest sqrt(m/k) of all grains
  Sides sides = Sides::walls;
  bool bonded_plates = false;  // the snow is frozen to the plates
  int threads = 0;             // 0: all

  /// The smallest length that the method resolves, m; 0 if the sample's file determines it.
  double resolution() const { return 0; }
};

}  // namespace snowshed::methods::grains
