// Four doubles at a time, and rows of four that are taken apart into columns: for data that lie in
// memory as records of four values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "snowshed/core/simd_pack.hpp"

SNOWSHED_VARIANT_BEGIN

typedef double Quad __attribute__((vector_size(32), may_alias));
typedef std::int64_t QuadMask __attribute__((vector_size(32), may_alias));
typedef std::int32_t QuadIndex __attribute__((vector_size(16), may_alias));

/// A record of four values in memory.
SNOWSHED_INLINE Quad load_row(const double* p) {
  Quad v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
SNOWSHED_INLINE void store_row(double* p, const Quad& v) { std::memcpy(p, &v, sizeof v); }

/// Takes four rows apart: on return a holds the first value of each, b the second, and so on.
SNOWSHED_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6);  // a0 b0 a2 b2
  const Quad ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Quad cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Quad cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

/// 1/sqrt(x) for 1e-37 < x < 1e37, to the last digit or two: an estimate that the processor gives,
/// improved by Newton's iteration. A root and a division would take several times as long.
template <class V>
SNOWSHED_INLINE V inverse_sqrt(const V& x) {
  [[maybe_unused]] const auto improved = [&](const V& y) { return V(y * (1.5 - 0.5 * x * y * y)); };
#if defined(__AVX512F__) && defined(__AVX512VL__)
  if constexpr (sizeof(V) == 64)
    return improved(improved((V)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)x)));
  else
    return improved(improved((V)_mm256_maskz_rsqrt14_pd(0xf, (__m256d)x)));
#elif defined(__AVX2__)
  return improved(
      improved(improved((V)_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps((__m256d)x))))));
#else
  return 1.0 / sqrt(x);
#endif
}

SNOWSHED_VARIANT_END
