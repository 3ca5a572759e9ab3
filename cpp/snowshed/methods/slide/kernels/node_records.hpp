// Packs of particles, and records of four values that nodes hold: read for a pack of places at once.
#pragma once

#include "snowshed/core/simd_quad.hpp"

SNOWSHED_VARIANT_BEGIN

/// A pack holds one value of four particles, or of eight where a register has room for them: at
/// least as many as the values of a record, which are taken apart into packs.
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

/// A record of each lane, taken apart into its four values, and put together again.
struct PackRecord {
  Pack a, b, c, d;
};
template <class Row>
SNOWSHED_INLINE Pack joined(const Row& low, const Row& high) {
  if constexpr (pack_lanes == 8)
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  else
    return low;
}
template <int half, class Values>
SNOWSHED_INLINE Quad half_of(const Values& v) {
  if constexpr (pack_lanes == 4)
    return v;
  else if constexpr (half == 0)
    return __builtin_shufflevector(v, v, 0, 1, 2, 3);
  else
    return __builtin_shufflevector(v, v, 4, 5, 6, 7);
}
SNOWSHED_INLINE PackRecord taken_apart(Quad (&rows)[pack_lanes]) {
  constexpr int second = pack_lanes - 4;
  transpose(rows[0], rows[1], rows[2], rows[3]);
  if constexpr (second > 0)
    transpose(rows[second], rows[second + 1], rows[second + 2], rows[second + 3]);
  return {joined(rows[0], rows[second]), joined(rows[1], rows[second + 1]),
          joined(rows[2], rows[second + 2]), joined(rows[3], rows[second + 3])};
}
SNOWSHED_INLINE void put_together(const PackRecord& r, Quad (&rows)[pack_lanes]) {
  rows[0] = half_of<0>(r.a);
  rows[1] = half_of<0>(r.b);
  rows[2] = half_of<0>(r.c);
  rows[3] = half_of<0>(r.d);
  transpose(rows[0], rows[1], rows[2], rows[3]);
  constexpr int second = pack_lanes - 4;
  if constexpr (second > 0) {
    rows[second] = half_of<1>(r.a);
    rows[second + 1] = half_of<1>(r.b);
    rows[second + 2] = half_of<1>(r.c);
    rows[second + 3] = half_of<1>(r.d);
    transpose(rows[second], rows[second + 1], rows[second + 2], rows[second + 3]);
  }
}

SNOWSHED_INLINE Pack load_pack(const double* p) {
  Pack v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
SNOWSHED_INLINE void store_pack(double* p, const Pack& v) { std::memcpy(p, &v, sizeof v); }

/// What is read of the records of the four nodes around a place.
enum class NodeRecord {
  mean,             // the bilinear mean
  mean_and_known,   // the same, but the last value is NaN where the first one of node 0 is
  mean_and_middle,  // the bilinear mean of the first value, the plain means of the others
};

/// The bilinear weights of the nodes in the south-west (0), south-east, north-west and north-east.
struct NodeWeights {
  Pack of[4];
};

#ifdef __AVX512F__
/// The nodes to the west and to the east are neighbours in memory and fill a register.
template <NodeRecord record>
SNOWSHED_INLINE Pack node_record(const Pack& south, const Pack& north, const Pack& south_weights,
                                 const Pack& north_weights) {
  const Pack parts = south_weights * south + north_weights * north;
  if constexpr (record == NodeRecord::mean) return parts;
  if constexpr (record == NodeRecord::mean_and_known)  // areas are finite
    return __builtin_shufflevector(parts, south, 0, 1, 2, 8, 4, 5, 6, 15);
  const Pack quarter = 0.25 * (south + north);
  return __builtin_shufflevector(parts, quarter, 0, 9, 10, 11, 4, 13, 14, 15);
}

/// Records of a pack of places, the first nodes of which are given.
template <NodeRecord record>
SNOWSHED_INLINE PackRecord records_of(const double* nodes, int columns, const PackIndex& first,
                                      const NodeWeights& weights) {
  Pack parts[8];
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    const double* south = nodes + 4 * std::ptrdiff_t(first[i]);
    const PackMask lane = PackMask{0, 0, 0, 0, 8, 8, 8, 8} + i;
    parts[i] = node_record<record>(load_pack(south), load_pack(south + 4 * std::ptrdiff_t(columns)),
                                   __builtin_shuffle(weights.of[0], weights.of[1], lane),
                                   __builtin_shuffle(weights.of[2], weights.of[3], lane));
  }
  const auto whole = [&](int i) SNOWSHED_INLINE_LAMBDA {  // lanes i and i + 4, west and east added
    const Pack &a = parts[i], &b = parts[i + 4];
    return Pack(__builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11) +
                __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15));
  };
  const Pack r0 = whole(0), r1 = whole(1), r2 = whole(2), r3 = whole(3);
  const Pack even01 = __builtin_shufflevector(r0, r1, 0, 8, 2, 10, 4, 12, 6, 14);
  const Pack odd01 = __builtin_shufflevector(r0, r1, 1, 9, 3, 11, 5, 13, 7, 15);
  const Pack even23 = __builtin_shufflevector(r2, r3, 0, 8, 2, 10, 4, 12, 6, 14);
  const Pack odd23 = __builtin_shufflevector(r2, r3, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(even01, even23, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(odd01, odd23, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(even01, even23, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(odd01, odd23, 2, 3, 10, 11, 6, 7, 14, 15)};
}
#else
template <NodeRecord record>
SNOWSHED_INLINE Quad node_record(const Quad (&n)[4], const double (&w)[4]) {
  const Quad mean = w[0] * n[0] + w[1] * n[1] + w[2] * n[2] + w[3] * n[3];
  if constexpr (record == NodeRecord::mean) return mean;
  if constexpr (record == NodeRecord::mean_and_known)
    return __builtin_shufflevector(mean, n[0], 0, 1, 2, 4);
  const Quad quarter = 0.25 * (n[0] + n[1] + n[2] + n[3]);
  return __builtin_shufflevector(mean, quarter, 0, 5, 6, 7);
}

/// Records of a pack of places, the first nodes of which are given.
template <NodeRecord record>
SNOWSHED_INLINE PackRecord records_of(const double* nodes, int columns, const PackIndex& first,
                                      const NodeWeights& weights) {
  alignas(pack_bytes) double w[4][pack_lanes];
  for (int k = 0; k < 4; ++k) store_pack(w[k], weights.of[k]);
  Quad rows[pack_lanes];
  for (int i = 0; i < pack_lanes; ++i) {
    const double* a = nodes + 4 * std::ptrdiff_t(first[i]);
    const double* b = a + 4 * std::ptrdiff_t(columns);
    rows[i] = node_record<record>({load_row(a), load_row(a + 4), load_row(b), load_row(b + 4)},
                                  {w[0][i], w[1][i], w[2][i], w[3][i]});
  }
  return taken_apart(rows);
}
#endif

SNOWSHED_VARIANT_END
