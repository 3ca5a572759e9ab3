// Vectors of three components, each a number or a pack of them.
#pragma once

#include "snowshed/core/simd_pack.hpp"

SNOWSHED_VARIANT_BEGIN

template <class V>
struct SimdVec {
  V x, y, z;
};
template <class V>
SNOWSHED_INLINE SimdVec<V> operator+(const SimdVec<V>& a, const SimdVec<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
SNOWSHED_INLINE SimdVec<V> operator-(const SimdVec<V>& a, const SimdVec<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
SNOWSHED_INLINE SimdVec<V> operator*(const V& s, const SimdVec<V>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class V>
SNOWSHED_INLINE V dot(const SimdVec<V>& a, const SimdVec<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
SNOWSHED_INLINE SimdVec<V> cross(const SimdVec<V>& a, const SimdVec<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns the components of `a` where the mask is set, and those of `b` elsewhere.
template <class Mask, class V>
SNOWSHED_INLINE SimdVec<V> select(const Mask& mask, const SimdVec<V>& a, const SimdVec<V>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

SNOWSHED_VARIANT_END
