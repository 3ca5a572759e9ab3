// A SIMD register's worth of values, by the compiler's vector extension: with AVX-512
// `Lanes<float>` holds 16 floats, `Lanes<double>` 8 doubles. Arithmetic and comparison work as on
// scalars; a comparison gives a mask for `select`. Functions written for `V` accept a plain float
// or double too, which is how the material laws are tested.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "snowshed/support/variant.hpp"

SNOWSHED_VARIANT_BEGIN

#if defined(__AVX512F__)
inline constexpr int lane_bytes = 64;
#elif defined(__AVX__)
inline constexpr int lane_bytes = 32;
#else
inline constexpr int lane_bytes = 16;
#endif

template <class T>
struct LaneTypes;
template <>
struct LaneTypes<float> {
  typedef float type __attribute__((vector_size(lane_bytes), may_alias));
  typedef std::int32_t mask __attribute__((vector_size(lane_bytes), may_alias));
};
template <>
struct LaneTypes<double> {
  typedef double type __attribute__((vector_size(lane_bytes), may_alias));
  typedef std::int64_t mask __attribute__((vector_size(lane_bytes), may_alias));
};

template <class T>
using Lanes = typename LaneTypes<T>::type;

/// What a comparison of Lanes<T> gives: in each lane all bits or none.
template <class T>
using LaneMask = typename LaneTypes<T>::mask;

template <class T>
inline constexpr int lane_count = lane_bytes / int(sizeof(T));

/// The scalar inside V: float for Lanes<float> and for float.
template <class V, class = void>
struct ScalarOf {
  using type = std::remove_cv_t<std::remove_reference_t<decltype(std::declval<V&>()[0])>>;
};
template <class V>
struct ScalarOf<V, std::enable_if_t<std::is_floating_point_v<V>>> {
  using type = V;
};
template <class V>
using Scalar = typename ScalarOf<V>::type;

template <class V>
inline constexpr bool is_lanes = !std::is_floating_point_v<V>;

/// All lanes equal to x.
template <class V>
SNOWSHED_INLINE V broadcast(Scalar<V> x) {
  if constexpr (is_lanes<V>)
    return x - V{};
  else
    return x;
}

/// A constant as lanes: all equal to it, or those it has.
template <class V, class C>
SNOWSHED_INLINE V spread(const C& c) {
  if constexpr (std::is_same_v<V, C>)
    return c;
  else
    return broadcast<V>(c);
}

/// mask ? a : b, lane by lane.
template <class M, class V>
SNOWSHED_INLINE V select(const M& mask, const V& a, const V& b) {
  return mask ? a : b;
}

/// Bits that are set in any lane.
template <class M>
SNOWSHED_INLINE auto bits_in(const M& mask) {
  constexpr int n = int(sizeof(M) / sizeof(mask[0]));
  auto bits = mask[0];
  for (int i = 1; i < n; ++i) bits |= mask[i];
  return bits;
}

template <class M>
SNOWSHED_INLINE bool any(const M& mask) {
  if constexpr (std::is_integral_v<M>)
    return mask;
  else
    return bits_in(mask) != 0;
}

template <class V>
SNOWSHED_INLINE V sqrt(const V& x) {
  if constexpr (is_lanes<V>) {
    V r;
    for (int i = 0; i < int(sizeof(V) / sizeof(x[0])); ++i) r[i] = std::sqrt(x[i]);
    return r;
  } else {
    return std::sqrt(x);
  }
}

template <class V>
SNOWSHED_INLINE V abs(const V& x) {
  return select(x < Scalar<V>(0), V(-x), x);
}
template <class V>
SNOWSHED_INLINE V max(const V& a, const V& b) {
  return select(a > b, a, b);
}
template <class V>
SNOWSHED_INLINE V min(const V& a, const V& b) {
  return select(a < b, a, b);
}
template <class V>
SNOWSHED_INLINE V clamp(const V& x, const V& lo, const V& hi) {
  return max(lo, min(x, hi));
}

/// The largest lane.
template <class V>
SNOWSHED_INLINE Scalar<V> largest(const V& x) {
  if constexpr (is_lanes<V>) {
    Scalar<V> r = x[0];
    for (int i = 1; i < int(sizeof(V) / sizeof(x[0])); ++i) r = x[i] > r ? x[i] : r;
    return r;
  } else {
    return x;
  }
}

/// Read the first n values at p; the lanes beyond repeat the first one, so that they hold
/// harmless numbers without touching memory that belongs to somebody else.
template <class T>
SNOWSHED_INLINE Lanes<T> load(const T* p, int n) {
  Lanes<T> v;
  if (n == lane_count<T>) {
    std::memcpy(&v, p, sizeof v);
  } else {
    v = broadcast<Lanes<T>>(p[0]);
    for (int i = 1; i < n; ++i) v[i] = p[i];
  }
  return v;
}

template <class T>
SNOWSHED_INLINE void store(T* p, const Lanes<T>& v, int n) {
  if (n == lane_count<T>) {
    std::memcpy(p, &v, sizeof v);
  } else {
    for (int i = 0; i < n; ++i) p[i] = v[i];
  }
}

SNOWSHED_VARIANT_END
