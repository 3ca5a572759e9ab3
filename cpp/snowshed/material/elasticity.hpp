// Isotropic Hencky elasticity: the St. Venant-Kirchhoff energy in the Hencky strain (thesis 1.2.5).
#pragma once

#include <cmath>

#include "snowshed/core/variant.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(material)

/// Elastic constants in d dimensions. Two dimensions are plane strain with all invariants taken in
/// the plane, as in the thesis: p = -tr(tau)/d. T is a scalar, or a SIMD pack if each particle has
/// its own constants.
template <class T>
struct Elasticity {
  T lambda{};  ///< Lame's first parameter, Pa
  T mu{};      ///< shear modulus, Pa
  T bulk{};    ///< K_d = lambda + 2 mu/d, Pa

  /// Returns the constants from Young's modulus (Pa) and Poisson's ratio. The thesis's (1.1.34)
  /// prints mu on both sides; E is meant.
  static Elasticity from(double youngs_modulus, double poissons_ratio, int dimension) {
    const double lambda =
        youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
    const double mu = youngs_modulus / (2 * (1 + poissons_ratio));
    return {T(lambda), T(mu), T(lambda + 2 * mu / dimension)};
  }
};

SNOWSHED_MODULE_VARIANT_END
