// Vectors of four doubles, for data that are stored as records of four values.
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

/// 1/sqrt(x) for 1e-37 < x < 1e37, with an error of one or two units in the last digit. A root and
/// a division would take several times as long. With the processor's estimate y and e = 1 - x y^2,
///
///   1/sqrt(x) = y (1 - e)^(-1/2) = y (1 + e/2 + 3 e^2/8 + 5 e^3/16 + ...).
///
/// These four terms reach a relative error of 2^-53 if that of the estimate is below 2^-14. A less
/// accurate estimate is first improved by a Newton step (the first two terms).
template <class V>
SNOWSHED_INLINE V inverse_sqrt(const V& x) {
  [[maybe_unused]] const auto improved = [&](const V& y) { return V(y * (1.5 - 0.5 * x * y * y)); };
  [[maybe_unused]] const auto finished = [&](const V& y) {
    const V e = 1.0 - (x * y) * y;
    return V(y + (y * e) * (0.5 + e * (0.375 + 0.3125 * e)));
  };
#if defined(__AVX512F__) && defined(__AVX512VL__)
  if constexpr (sizeof(V) == 64)
    return finished((V)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)x));
  else
    return finished((V)_mm256_maskz_rsqrt14_pd(0xf, (__m256d)x));
#elif defined(__AVX2__)
  return finished(improved((V)_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps((__m256d)x)))));
#else
  return 1.0 / sqrt(x);
#endif
}

SNOWSHED_VARIANT_END
