// The snow that the tests of Cam-Clay share.
#pragma once

#include "material/rate_integration.hpp"
#include "snowshed/material/cam_clay.hpp"

// A vector type as template argument loses its alignment, which does not matter here.
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace snowshed::cam_clay_testing {

inline constexpr material::LawConstants calibrated{1e6, 0.3, 0.5, 0.2, 0.1};

template <class T>
material::CamClay<T> law_of(const material::LawConstants& s, int dimension = 3) {
  return material::CamClay<T>::from(s.youngs_modulus, s.poissons_ratio, s.slope, s.cohesion,
                                    s.hardening, dimension);
}

}  // namespace snowshed::cam_clay_testing
