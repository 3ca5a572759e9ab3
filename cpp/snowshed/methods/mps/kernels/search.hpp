// The search for neighbours.
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/particles/neighbour_search.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

/// Returns a bit for each lane of a mask of doubles; the first lane has the lowest bit.
SNOWSHED_INLINE unsigned lane_bits(const SimdMask<double>& mask) {
#if defined(__AVX512DQ__)
  return _mm512_movepi64_mask((__m512i)mask);
#elif defined(__AVX2__)
  return unsigned(_mm256_movemask_pd((__m256d)mask));
#else
  unsigned bits = 0;
  for (int k = 0; k < simd_width<double>; ++k) bits |= unsigned(mask[k] & 1) << k;
  return bits;
#endif
}

/// Writes `from` plus the index of each set bit, in ascending order; returns their number. It may
/// change eight values of `to`.
SNOWSHED_INLINE std::size_t write_set_bits(unsigned bits, std::uint32_t from, std::uint32_t* to) {
#if defined(__AVX512VL__)
  const __m256i all =
      _mm256_add_epi32(_mm256_set1_epi32(int(from)), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(__mmask8(bits), all));
  return std::size_t(__builtin_popcount(bits));
#else
  std::size_t n = 0;
  for (; bits != 0; bits &= bits - 1) to[n++] = from + std::uint32_t(__builtin_ctz(bits));
  return n;
#endif
}

template <int D>
SNOWSHED_INLINE std::size_t find_near(const particles::SearchedPoints<D>& points, std::uint32_t i,
                                      std::uint32_t begin, std::uint32_t end,
                                      std::uint32_t* neighbours) {
  using V = SimdPack<double>;
  constexpr std::uint32_t lanes = simd_width<double>;
  static_assert(lanes <= particles::SearchedPoints<D>::spare);
  const double radius2 = points.radius * points.radius, period = points.period;
  std::size_t n = 0;
  for (std::uint32_t j = begin; j < end; j += lanes) {
    V square{};
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      V difference;
      std::memcpy(&difference, points.coordinate[d] + j, sizeof difference);
      difference -= points.coordinate[d][i];
      if (d == 0 && period > 0) difference = min(abs(difference), V(period - abs(difference)));
      square += difference * difference;
    }
    unsigned bits = lane_bits(square < radius2);
    if (end - j < lanes) bits &= (1u << (end - j)) - 1;
    if (i - j < lanes) bits &= ~(1u << (i - j));
    n += write_set_bits(bits, j, neighbours + n);
  }
  return n;
}

SNOWSHED_MODULE_VARIANT_END
