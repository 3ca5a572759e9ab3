// Packs of particles, and the nodes' records of four values, which are interpolated for a pack of
// positions at once.
#pragma once

#include "snowshed/core/simd_quad.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// A pack holds one value of four particles, or of eight if a register has room for them. It has at
/// least as many lanes as a record has values, because records are transposed to packs.
inline constexpr int pack_bytes = simd_bytes > 32 ? simd_bytes : 32;
inline constexpr int pack_lanes = pack_bytes / int(sizeof(double));
typedef double Pack __attribute__((vector_size(pack_bytes), may_alias));
typedef std::int64_t PackMask __attribute__((vector_size(pack_bytes), may_alias));
typedef std::int32_t PackIndex __attribute__((vector_size(pack_bytes / 2), may_alias));

inline constexpr PackMask all_lanes = ~PackMask{};

SNOWSHED_INLINE bool any_lane(const PackMask& mask) {
#ifdef __AVX512F__
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#else
  return any(mask);
#endif
}

// The compiler would split eight lanes into halves for these conversions.
SNOWSHED_INLINE Pack as_doubles(const PackIndex& v) {
#ifdef __AVX512F__
  return (Pack)_mm512_cvtepi32_pd((__m256i)v);
#else
  return __builtin_convertvector(v, Pack);
#endif
}
SNOWSHED_INLINE PackMask as_mask(const PackIndex& v) {
#ifdef __AVX512F__
  return (PackMask)_mm512_cvtepi32_epi64((__m256i)v);
#else
  return __builtin_convertvector(v, PackMask);
#endif
}

SNOWSHED_INLINE double sum_of_lanes(const Pack& v) {
  double sum = 0;
  for (int i = 0; i < pack_lanes; ++i) sum += v[i];
  return sum;
}

struct PackRecord {
  Pack a, b, c, d;
};

/// Exchanges rows and columns of four packs, within each half of a pack if it has eight lanes.
SNOWSHED_INLINE PackRecord transposed(const PackRecord& r) {
  Pack rows[4] = {r.a, r.b, r.c, r.d};
  transpose(rows);
  return {rows[0], rows[1], rows[2], rows[3]};
}

/// The records of all lanes, transposed to packs of their values; record(i) is the record of lane
/// i.
template <class RecordOf>
SNOWSHED_INLINE PackRecord transposed_to_packs(const RecordOf& record) {
#ifdef __AVX512F__
  const auto both = [&](int i) SNOWSHED_INLINE_LAMBDA {
    return __builtin_shufflevector(record(i), record(i + 4), 0, 1, 2, 3, 4, 5, 6, 7);
  };
  return transposed({both(0), both(1), both(2), both(3)});
#else
  return transposed({record(0), record(1), record(2), record(3)});
#endif
}

/// The records of all lanes, one a row.
struct PackRows {
  Quad of[pack_lanes];
};
SNOWSHED_INLINE PackRows transposed_to_rows(const PackRecord& r) {
  const PackRecord t = transposed(r);
#ifdef __AVX512F__
  const auto low = [](const Pack& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); };
  const auto high = [](const Pack& v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); };
  return {{low(t.a), low(t.b), low(t.c), low(t.d), high(t.a), high(t.b), high(t.c), high(t.d)}};
#else
  return {{t.a, t.b, t.c, t.d}};
#endif
}

SNOWSHED_INLINE Pack load_whole_pack(const double* p) { return load_pack<Pack>(p, pack_lanes); }

/// Interpolation of the records of a cell's four nodes.
enum class Interpolation {
  bilinear,                    // the bilinear mean
  bilinear_with_mask,          // the same, but the last value is NaN if the first one of node 0 is
  bilinear_first_mean_others,  // the bilinear mean of the first value, the plain means of the
                               // others
};

/// The bilinear weights of the nodes in the south-west (0), south-east, north-west and north-east.
struct NodeWeights {
  Pack of[4];
};

#ifdef __AVX512F__
/// The nodes to the west and to the east are neighbours in memory and fill a register.
template <Interpolation interpolation>
SNOWSHED_INLINE Pack node_record(const Pack& south, const Pack& north, const Pack& south_weights,
                                 const Pack& north_weights) {
  // The height has the same bits for every Interpolation, so that snow at rest does not creep.
  const Pack parts = (Pack)_mm512_fmadd_pd((__m512d)south_weights, (__m512d)south,
                                           _mm512_mul_pd((__m512d)north_weights, (__m512d)north));
  if constexpr (interpolation == Interpolation::bilinear) return parts;
  if constexpr (interpolation == Interpolation::bilinear_with_mask)  // areas are finite
    return __builtin_shufflevector(parts, south, 0, 1, 2, 8, 4, 5, 6, 15);
  const Pack quarter = 0.25 * (south + north);
  return __builtin_shufflevector(parts, quarter, 0, 9, 10, 11, 4, 13, 14, 15);
}

/// Interpolated records of a pack of positions; `first` are the south-west nodes of their cells.
template <Interpolation interpolation>
SNOWSHED_INLINE PackRecord records_of(const double* nodes, int columns, const PackIndex& first,
                                      const NodeWeights& weights) {
  Pack parts[8];
  const auto four_of = [](const Pack& west, const Pack& east, const PackMask& lane) {
    return (Pack)_mm512_permutex2var_pd((__m512d)west, (__m512i)lane, (__m512d)east);
  };
  SNOWSHED_UNROLL
  for (int i = 0; i < 8; ++i) {
    const double* south = nodes + 4 * std::ptrdiff_t(first[i]);
    const PackMask lane = PackMask{0, 0, 0, 0, 8, 8, 8, 8} + i;
    parts[i] = node_record<interpolation>(
        load_whole_pack(south), load_whole_pack(south + 4 * std::ptrdiff_t(columns)),
        four_of(weights.of[0], weights.of[1], lane), four_of(weights.of[2], weights.of[3], lane));
  }
  const auto record_of =
      [&](int i) SNOWSHED_INLINE_LAMBDA {  // lanes i and i + 4, west and east added
        const Pack &a = parts[i], &b = parts[i + 4];
        return Pack(__builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
                    __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15));
      };
  return transposed({record_of(0), record_of(1), record_of(2), record_of(3)});
}
#else
template <Interpolation interpolation>
SNOWSHED_INLINE Quad node_record(const Quad (&n)[4], const double (&w)[4]) {
  const Quad mean = w[0] * n[0] + w[1] * n[1] + w[2] * n[2] + w[3] * n[3];
  if constexpr (interpolation == Interpolation::bilinear) return mean;
  if constexpr (interpolation == Interpolation::bilinear_with_mask)
    return __builtin_shufflevector(mean, n[0], 0, 1, 2, 4);
  const Quad quarter = 0.25 * (n[0] + n[1] + n[2] + n[3]);
  return __builtin_shufflevector(mean, quarter, 0, 5, 6, 7);
}

/// Interpolated records of a pack of positions; `first` are the south-west nodes of their cells.
template <Interpolation interpolation>
SNOWSHED_INLINE PackRecord records_of(const double* nodes, int columns, const PackIndex& first,
                                      const NodeWeights& weights) {
  alignas(pack_bytes) double w[4][pack_lanes];
  for (int k = 0; k < 4; ++k) store_pack(w[k], weights.of[k], pack_lanes);
  return transposed_to_packs([&](int i) SNOWSHED_INLINE_LAMBDA {
    const double* a = nodes + 4 * std::ptrdiff_t(first[i]);
    const double* b = a + 4 * std::ptrdiff_t(columns);
    return node_record<interpolation>({load_row(a), load_row(a + 4), load_row(b), load_row(b + 4)},
                                      {w[0][i], w[1][i], w[2][i], w[3][i]});
  });
}
#endif

SNOWSHED_MODULE_VARIANT_END
