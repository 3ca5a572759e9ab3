// Stands in for core/simd_math.hpp on a graphics card.
#pragma once

#include "snowshed/core/simd_pack.hpp"

SNOWSHED_VARIANT_BEGIN

/// log(1 + a) for a > -1.
template <class V>
SNOWSHED_INLINE V log1p(const V& a) {
  return ::log1p(a);
}

/// exp(x) - 1.
template <class V>
SNOWSHED_INLINE V expm1(const V& x) {
  return ::expm1(x);
}

SNOWSHED_VARIANT_END
