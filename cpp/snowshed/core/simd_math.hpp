// exp and log on lanes. Taylor and atanh series after range reduction: no tables, no calls, and
// full relative accuracy near zero, where elastic strains live.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "snowshed/core/simd_pack.hpp"

SNOWSHED_VARIANT_BEGIN

namespace detail {

template <class T>
struct FloatBits;
template <>
struct FloatBits<float> {
  using Int = std::int32_t;
  static constexpr int mantissa = 23, bias = 127, log_terms = 5, exp_terms = 9;
  static constexpr float round_magic = 12582912.0f;  // 1.5 * 2^23
  static constexpr float exp_limit = 87.0f;
};
template <>
struct FloatBits<double> {
  using Int = std::int64_t;
  static constexpr int mantissa = 52, bias = 1023, log_terms = 11, exp_terms = 14;
  static constexpr double round_magic = 6755399441055744.0;  // 1.5 * 2^52
  static constexpr double exp_limit = 708.0;
};

template <class To, class From>
SNOWSHED_INLINE To bits_of(const From& x) {
  static_assert(sizeof(To) == sizeof(From));
  To r;
  std::memcpy(&r, &x, sizeof r);
  return r;
}

}  // namespace detail

/// log(1 + a) for a > -1.
template <class V>
SNOWSHED_INLINE V log1p(const V& a) {
  using T = Scalar<V>;
  if constexpr (!is_simd_pack<V>) {
    return std::log1p(a);
  } else {
    using Bits = detail::FloatBits<T>;
    using I = typename SimdTypes<T>::mask;
    using Int = typename Bits::Int;
    const V tiny = broadcast<V>(T(1e-30));
    const V u = max(V(a + T(1)), tiny);
    // u = m 2^e with m in [sqrt(1/2), sqrt(2))
    const Int half_sqrt2 = detail::bits_of<Int>(T(0.70710678118654752440));
    const I shifted = detail::bits_of<I>(u) - half_sqrt2;
    const I e = shifted >> Bits::mantissa;
    const V m = detail::bits_of<V>(I(detail::bits_of<I>(u) - (e << Bits::mantissa)));
    const V f = m - T(1);
    const V s = f / (f + T(2));
    const V z = s * s;
    V series = broadcast<V>(T(1) / T(2 * Bits::log_terms + 1));
    for (int k = Bits::log_terms - 1; k >= 0; --k) series = series * z + T(1) / T(2 * k + 1);
    const V rounding = (a - (u - T(1))) / u;  // rounding error of 1 + a
    return __builtin_convertvector(e, V) * T(0.69314718055994530942) +
           (T(2) * s * series + rounding);
  }
}

/// exp(x) - 1; the argument is held within the range of the type.
template <class V>
SNOWSHED_INLINE V expm1(const V& x_in) {
  using T = Scalar<V>;
  if constexpr (!is_simd_pack<V>) {
    return std::expm1(x_in);
  } else {
    using Bits = detail::FloatBits<T>;
    using I = typename SimdTypes<T>::mask;
    using Int = typename Bits::Int;
    const V x = clamp(x_in, broadcast<V>(-Bits::exp_limit), broadcast<V>(Bits::exp_limit));
    const V shifted = x * T(1.44269504088896340736) + Bits::round_magic;
    const V k = shifted - Bits::round_magic;
    constexpr T ln2_high = sizeof(T) == 4 ? T(0.693145751953125) : T(0.69314718036912381649);
    constexpr T ln2_low =
        sizeof(T) == 4 ? T(1.42860682030941723e-6) : T(1.90821492927058770002e-10);
    const V r = (x - k * ln2_high) - k * ln2_low;
    V series = broadcast<V>(T(1));  // sum of r^n/(n+1)!
    for (int n = Bits::exp_terms; n >= 2; --n) series = series * r * (T(1) / T(n)) + T(1);
    const I exponent = detail::bits_of<I>(shifted) - detail::bits_of<Int>(Bits::round_magic);
    const V scale = detail::bits_of<V>(I((exponent + Int(Bits::bias)) << Bits::mantissa));
    return scale * (r * series) + (scale - T(1));
  }
}

SNOWSHED_VARIANT_END
