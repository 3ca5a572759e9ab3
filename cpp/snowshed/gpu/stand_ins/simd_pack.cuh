// Stands in for core/simd_pack.hpp on a graphics card, where a thread has one particle: a pack is a
// float or a double, and a mask is a bool.
#pragma once

#include "snowshed/core/variant.hpp"

SNOWSHED_VARIANT_BEGIN

template <class V>
using Scalar = V;

template <class V>
inline constexpr bool is_simd_pack = false;

template <class V>
inline constexpr int lane_count = 1;

template <class V, class C>
SNOWSHED_INLINE V broadcast(const C& value) {
  return V(value);
}
template <class M, class V>
SNOWSHED_INLINE V select(const M& mask, const V& a, const V& b) {
  return mask ? a : b;
}
SNOWSHED_INLINE bool any(bool mask) { return mask; }

template <class V>
SNOWSHED_INLINE V sqrt(const V& x) {
  return ::sqrt(x);
}
template <class V>
SNOWSHED_INLINE V floor(const V& x) {
  return ::floor(x);
}
template <class V>
SNOWSHED_INLINE V abs(const V& x) {
  return ::fabs(x);
}
template <class V>
SNOWSHED_INLINE V max(const V& a, const V& b) {
  return a > b ? a : b;
}
template <class V>
SNOWSHED_INLINE V min(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
SNOWSHED_INLINE V clamp(const V& x, const V& lo, const V& hi) {
  return max(lo, min(x, hi));
}
template <class V>
SNOWSHED_INLINE V largest(const V& x) {
  return x;
}

SNOWSHED_VARIANT_END
