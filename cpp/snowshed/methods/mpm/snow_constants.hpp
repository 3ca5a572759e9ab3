// Constants of a snow for the kernels. A graphics card compiles this file, too.
#pragma once

#include "snowshed/core/variant.hpp"

namespace snowshed::methods::mpm {

/// Largest norm of the elastic Hencky strain that single precision still resolves: compression to a
/// twentieth of the length, or stretching to twenty times the length. Snow yields long before. Only
/// bodies that are much too soft for their speed reach this strain.
inline constexpr double elastic_strain_limit = 3.0;

/// Constants of a snow for the kernels. C is a scalar, or a SIMD pack: one value for each particle
/// of a chunk.
template <class C>
struct MaterialConstants {
  C lambda, mu, bulk;         // Pa, see Elasticity
  C m2, beta, xi, hardening;  // see CamClay
  C specific_volume;          // m3/kg, before any deformation
  C softening, band_begin;    // crack band, see CamClayLaw
};

}  // namespace snowshed::methods::mpm

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Returns the Cam-Clay law with these constants.
template <template <class> class Law, class C>
SNOWSHED_INLINE Law<C> cam_clay_law(const MaterialConstants<C>& k) {
  return {{k.lambda, k.mu, k.bulk}, k.m2, k.beta, k.xi, k.hardening, k.softening, k.band_begin};
}

SNOWSHED_MODULE_VARIANT_END
