// A SIMD register's worth of values, by the compiler's vector extension: with AVX-512
// `SimdPack<float>` holds 16 floats, `SimdPack<double>` 8 doubles. Arithmetic and comparison work
// as on scalars; a comparison gives a mask for `select`. Functions written for `V` accept a plain
// float or double too, which is how the material laws are tested.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "snowshed/core/variant.hpp"

SNOWSHED_VARIANT_BEGIN

#if defined(__AVX512F__)
inline constexpr int simd_bytes = 64;
#elif defined(__AVX__)
inline constexpr int simd_bytes = 32;
#else
inline constexpr int simd_bytes = 16;
#endif

template <class T>
struct SimdTypes;
template <>
struct SimdTypes<float> {
  typedef float type __attribute__((vector_size(simd_bytes), may_alias));
  typedef std::int32_t mask __attribute__((vector_size(simd_bytes), may_alias));
};
template <>
struct SimdTypes<double> {
  typedef double type __attribute__((vector_size(simd_bytes), may_alias));
  typedef std::int64_t mask __attribute__((vector_size(simd_bytes), may_alias));
};

template <class T>
using SimdPack = typename SimdTypes<T>::type;

/// Result of a comparison of SimdPack<T>: all bits or none in each lane.
template <class T>
using SimdMask = typename SimdTypes<T>::mask;

template <class T>
inline constexpr int simd_width = simd_bytes / int(sizeof(T));

/// The scalar inside V: float for SimdPack<float> and for float.
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
inline constexpr bool is_simd_pack = !std::is_floating_point_v<V>;

template <class V>
inline constexpr int lane_count = int(sizeof(V) / sizeof(Scalar<V>));

/// Returns a scalar as a pack with this value in all lanes; returns a pack unchanged.
template <class V, class C>
SNOWSHED_INLINE V broadcast(const C& value) {
  if constexpr (std::is_same_v<V, C>)
    return value;
  else if constexpr (is_simd_pack<V>)
    return Scalar<V>(value) - V{};
  else
    return V(value);
}

/// mask ? a : b, lane by lane.
template <class M, class V>
SNOWSHED_INLINE V select(const M& mask, const V& a, const V& b) {
  return mask ? a : b;
}

/// Combines the lanes: one half with the other, until a single lane is left.
template <class V, class Combine, int... lane>
SNOWSHED_INLINE auto combine_lanes(const V& x, Combine combine,
                                   std::integer_sequence<int, lane...>) {
  constexpr int half = int(sizeof...(lane));
  if constexpr (half == 1) {
    return combine(x[0], x[1]);
  } else {
    const auto first = __builtin_shufflevector(x, x, lane...);
    const auto second = __builtin_shufflevector(x, x, (half + lane)...);
    return combine_lanes(combine(first, second), combine,
                         std::make_integer_sequence<int, half / 2>());
  }
}
template <class V, class Combine>
SNOWSHED_INLINE auto combine_lanes(const V& x, Combine combine) {
  constexpr int n = int(sizeof(V) / sizeof(x[0]));
  return combine_lanes(x, combine, std::make_integer_sequence<int, n / 2>());
}

/// Bits that are set in any lane.
template <class M>
SNOWSHED_INLINE auto bits_in(const M& mask) {
  return combine_lanes(mask,
                       [](const auto& a, const auto& b) SNOWSHED_INLINE_LAMBDA { return a | b; });
}

template <class M>
SNOWSHED_INLINE bool any(const M& mask) {
  if constexpr (std::is_integral_v<M>) return mask;
#if defined(__AVX512DQ__)
  else if constexpr (sizeof(M) == 64 && sizeof(mask[0]) == 4)
    return _mm512_movepi32_mask((__m512i)mask) != 0;
  else if constexpr (sizeof(M) == 64)
    return _mm512_movepi64_mask((__m512i)mask) != 0;
#elif defined(__AVX2__)
  else if constexpr (sizeof(M) == 32)
    return _mm256_movemask_ps((__m256)mask) != 0;
#endif
  else
    return bits_in(mask) != 0;
}

template <class V>
SNOWSHED_INLINE V sqrt(const V& x) {
  if constexpr (is_simd_pack<V>) {
    V r;
    for (int i = 0; i < int(sizeof(V) / sizeof(x[0])); ++i) r[i] = std::sqrt(x[i]);
    return r;
  } else {
    return std::sqrt(x);
  }
}

template <class V>
SNOWSHED_INLINE V floor(const V& x) {
  if constexpr (is_simd_pack<V>) {
    V r;
    for (int i = 0; i < lane_count<V>; ++i) r[i] = std::floor(x[i]);
    return r;
  } else {
    return std::floor(x);
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
  if constexpr (is_simd_pack<V>)
    return combine_lanes(
        x, [](const auto& a, const auto& b) SNOWSHED_INLINE_LAMBDA { return max(a, b); });
  else
    return x;
}

/// One step of a transposition: rows i and i + step exchange the lanes in which the bit `step` of
/// their number differs from that of their row.
template <int step, class V, int... lane>
SNOWSHED_INLINE void exchange(V& a, V& b, std::integer_sequence<int, lane...>) {
  constexpr int n = int(sizeof...(lane));
  const V first = __builtin_shufflevector(a, b, ((lane & step) != 0 ? n + lane - step : lane)...);
  b = __builtin_shufflevector(a, b, ((lane & step) != 0 ? n + lane : lane + step)...);
  a = first;
}

/// Interleaves a and b within each four lanes: a becomes {a0 b0 a1 b1} and b becomes {a2 b2 a3 b3},
/// by one instruction each.
template <class V, int... lane>
SNOWSHED_INLINE void interleave(V& a, V& b, std::integer_sequence<int, lane...>) {
  constexpr int n = int(sizeof...(lane));
  const V first = __builtin_shufflevector(a, b, (lane / 4 * 4 + lane % 4 / 2 + lane % 2 * n)...);
  b = __builtin_shufflevector(a, b, (lane / 4 * 4 + 2 + lane % 4 / 2 + lane % 2 * n)...);
  a = first;
}

template <int step, class V, int n>
SNOWSHED_INLINE void exchange_rows(V (&rows)[n]) {
  if constexpr (step < n) {
    constexpr auto lanes = std::make_integer_sequence<int, lane_count<V>>();
    SNOWSHED_UNROLL
    for (int i = 0; i < n; ++i)
      if ((i & step) == 0) exchange<step>(rows[i], rows[i + step], lanes);
    exchange_rows<2 * step>(rows);
  }
}

/// Transposes n packs of n lanes: lane j of row i becomes lane i of row j. If the packs have more
/// lanes, each square block is transposed.
template <class V, int n>
SNOWSHED_INLINE void transpose(V (&rows)[n]) {
  static_assert(lane_count<V> % n == 0);
  if constexpr (sizeof(rows[0][0]) == 4) {
    constexpr auto lanes = std::make_integer_sequence<int, lane_count<V>>();
    SNOWSHED_UNROLL
    for (int i = 0; i < n; i += 4) {
      V* r = rows + i;
      interleave(r[0], r[1], lanes);
      interleave(r[2], r[3], lanes);
      exchange<2>(r[0], r[2], lanes);
      exchange<2>(r[1], r[3], lanes);
      std::swap(r[1], r[2]);
    }
    exchange_rows<4>(rows);
  } else {
    exchange_rows<1>(rows);
  }
}

/// Returns a mask that is set in the first n lanes.
template <class V, int... lane>
SNOWSHED_INLINE auto first_lanes(int n, std::integer_sequence<int, lane...>) {
  using Mask = decltype(V{} < V{});
  using Index = std::remove_reference_t<decltype(Mask{}[0])>;
  return Mask{Index(lane)...} < Index(n) - Mask{};
}
template <class V>
SNOWSHED_INLINE auto first_lanes(int n) {
  return first_lanes<V>(n, std::make_integer_sequence<int, lane_count<V>>());
}

/// Loads the first n lanes from memory and takes the others from `rest`, without touching memory
/// behind the n values.
template <class V>
SNOWSHED_INLINE V load_first(const Scalar<V>* p, int n, const V& rest) {
  [[maybe_unused]] constexpr bool single = sizeof(Scalar<V>) == 4;
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && single)
    return (V)_mm512_mask_loadu_ps((__m512)rest, __mmask16((1u << n) - 1), p);
  if constexpr (sizeof(V) == 64 && !single)
    return (V)_mm512_mask_loadu_pd((__m512d)rest, __mmask8((1u << n) - 1), p);
#endif
#if defined(__AVX2__)
  const auto lanes = first_lanes<V>(n);
  if constexpr (sizeof(V) == 32 && single)
    return select(lanes, (V)_mm256_maskload_ps((const float*)p, (__m256i)lanes), rest);
  if constexpr (sizeof(V) == 32 && !single)
    return select(lanes, (V)_mm256_maskload_pd(p, (__m256i)lanes), rest);
  if constexpr (sizeof(V) == 16 && single)
    return select(lanes, (V)_mm_maskload_ps((const float*)p, (__m128i)lanes), rest);
#endif
  V v = rest;
  for (int i = 0; i < n; ++i) v[i] = p[i];
  return v;
}

template <class V>
SNOWSHED_INLINE void store_first(Scalar<V>* p, const V& v, int n) {
  [[maybe_unused]] constexpr bool single = sizeof(Scalar<V>) == 4;
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && single)
    return _mm512_mask_storeu_ps(p, __mmask16((1u << n) - 1), (__m512)v);
  if constexpr (sizeof(V) == 64 && !single)
    return _mm512_mask_storeu_pd(p, __mmask8((1u << n) - 1), (__m512d)v);
#endif
#if defined(__AVX2__)
  const auto lanes = first_lanes<V>(n);
  if constexpr (sizeof(V) == 32 && single)
    return _mm256_maskstore_ps((float*)p, (__m256i)lanes, (__m256)v);
  if constexpr (sizeof(V) == 32 && !single)
    return _mm256_maskstore_pd(p, (__m256i)lanes, (__m256d)v);
  if constexpr (sizeof(V) == 16 && single)
    return _mm_maskstore_ps((float*)p, (__m128i)lanes, (__m128)v);
#endif
  for (int i = 0; i < n; ++i) p[i] = v[i];
}

/// Reads the first n values at p; the lanes beyond repeat the first one, so that they hold harmless
/// numbers without touching memory behind the array.
template <class V>
SNOWSHED_INLINE V load_pack(const Scalar<V>* p, int n) {
  if (n < lane_count<V>) return load_first(p, n, broadcast<V>(p[0]));
  V v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
template <class T>
SNOWSHED_INLINE SimdPack<T> load(const T* p, int n) {
  return load_pack<SimdPack<T>>(p, n);
}

template <class V>
SNOWSHED_INLINE void store_pack(Scalar<V>* p, const V& v, int n) {
  if (n < lane_count<V>)
    store_first(p, v, n);
  else
    std::memcpy(p, &v, sizeof v);
}
template <class T>
SNOWSHED_INLINE void store(T* p, const SimdPack<T>& v, int n) {
  store_pack<SimdPack<T>>(p, v, n);
}

SNOWSHED_VARIANT_END
