// The parameters of snow and its constitutive laws.
#pragma once

#include <cmath>

namespace snowshed::material {

enum class SnowModel { cam_clay, elastic };

/// The largest number of different snows in a scene. A particle stores its material_id in a byte.
inline constexpr int max_materials = 256;

/// Cohesive Modified Cam-Clay snow (Gaume et al. 2018; thesis 1.2.5-1.2.7).
/// Defaults: the calibrated snow of Table 4.3.1.
struct Snow {
  SnowModel model = SnowModel::cam_clay;
  double density = 210.0;                    // kg/m3
  double youngs_modulus = 1.0e6;             // Pa
  double poissons_ratio = 0.3;               // -
  double critical_state_slope = 0.5;         // M, -
  double preconsolidation_pressure = 7.0e3;  // p0, Pa, initial value
  double cohesion = 0.2;                     // beta, -
  double hardening_factor = 0.1;             // xi, -

  /// Scales stiffness and strength from another density to this one, by powers of the density
  /// (Sigrist 2006, thesis 16736, ETH Zurich). Only ratios are used, because loose snow has a
  /// fraction of the strength and stiffness of these laws.
  void scale_from_density(double other) {
    const double ratio = density / other;
    youngs_modulus *= std::pow(ratio, 2.94);
    preconsolidation_pressure *= std::pow(ratio, 2.44);
  }
};

}  // namespace snowshed::material
