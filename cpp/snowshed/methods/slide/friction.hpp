// Friction between sliding snow and the ground.
#pragma once

#include "snowshed/methods/slide/settings.hpp"

namespace snowshed::methods::slide {

/// Shear stress at the base: a part that does not depend on the speed and one that grows with its
/// square. Voellmy (1955): tau = mu sigma + rho g |u|^2 / xi; Coulomb: tau = mu sigma.
struct BasalFriction {
  double friction = 0;  // mu
  double drag = 0;      // rho g / xi, kg/m3; 0 without turbulence

  static BasalFriction from(const Settings& s, double gravity) {
    return {s.friction,
            s.friction_law == FrictionLaw::voellmy ? s.density * gravity / s.turbulence : 0.0};
  }

  /// Returns the shear stress, Pa, at a normal stress (Pa) and a speed (m/s).
  double stress(double normal, double speed) const {
    return friction * normal + drag * speed * speed;
  }
};

}  // namespace snowshed::methods::slide
