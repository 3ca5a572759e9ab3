// Some particles at a time, a pack of them: where they lie on the ground, and what lies there.
#pragma once

#include "snowshed/core/simd_quad.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"

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

struct PackVec {
  Pack x, y, z;
};
SNOWSHED_INLINE PackVec operator+(const PackVec& a, const PackVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SNOWSHED_INLINE PackVec operator-(const PackVec& a, const PackVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SNOWSHED_INLINE PackVec operator*(const Pack& s, const PackVec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
SNOWSHED_INLINE Pack dot(const PackVec& a, const PackVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SNOWSHED_INLINE PackVec select(const PackMask& mask, const PackVec& a, const PackVec& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Below it a square counts as zero where a root is taken.
inline constexpr double least_square = 1e-30;
SNOWSHED_INLINE Pack length_from(const Pack& square) {
  const Pack s = max(square, broadcast<Pack>(least_square));
  return s * inverse_sqrt(s);
}

SNOWSHED_INLINE Pack load_pack(const double* p) {
  Pack v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
SNOWSHED_INLINE void store_pack(double* p, const Pack& v) { std::memcpy(p, &v, sizeof v); }

/// Up to a pack of neighbouring entries of an array; where there are fewer the first is repeated.
struct Lanes {
  std::ptrdiff_t first;
  int count;

  SNOWSHED_INLINE Pack load(const double* p) const {
    p += first;
    if (count == pack_lanes) return load_pack(p);
    Pack v = broadcast<Pack>(p[0]);
    for (int i = 1; i < count; ++i) v[i] = p[i];
    return v;
  }
  SNOWSHED_INLINE PackIndex load(const std::int32_t* p) const {
    p += first;
    PackIndex v;
    if (count == pack_lanes) {
      std::memcpy(&v, p, sizeof v);
      return v;
    }
    for (int i = 0; i < pack_lanes; ++i) v[i] = p[i < count ? i : 0];
    return v;
  }
  SNOWSHED_INLINE PackVec load(const double* x, const double* y, const double* z) const {
    return {load(x), load(y), load(z)};
  }
  SNOWSHED_INLINE void store(double* p, const Pack& v) const {
    p += first;
    if (count == pack_lanes)
      store_pack(p, v);
    else
      for (int i = 0; i < count; ++i) p[i] = v[i];
  }
  SNOWSHED_INLINE void store(std::int32_t* p, const PackIndex& v) const {
    p += first;
    if (count == pack_lanes)
      std::memcpy(p, &v, sizeof v);
    else
      for (int i = 0; i < count; ++i) p[i] = v[i];
  }
  SNOWSHED_INLINE void store(double* x, double* y, double* z, const PackVec& v) const {
    store(x, v.x);
    store(y, v.y);
    store(z, v.z);
  }
};

/// The entries of a range from its k-th pack on.
SNOWSHED_INLINE Lanes lanes_of(std::ptrdiff_t begin, std::ptrdiff_t end, int k) {
  const std::ptrdiff_t first = begin + std::ptrdiff_t(k) * pack_lanes;
  return {first, first + pack_lanes <= end ? pack_lanes : int(end - first)};
}

/// Calls f(lanes) for the entries of a range.
template <class F>
SNOWSHED_INLINE void for_each_lanes(std::ptrdiff_t begin, std::ptrdiff_t end, const F& f) {
  for (; begin < end; begin += pack_lanes) f(lanes_of(begin, end, 0));
}

/// Packs that go through a kernel together, phase by phase. The phases of one pack wait for each
/// other; those of several packs do not.
inline constexpr int packs_in_batch = 64 / pack_lanes;

/// Calls f(begin, end, packs) for batches of a range.
template <class F>
SNOWSHED_INLINE void for_each_batch(std::ptrdiff_t begin, std::ptrdiff_t end, const F& f) {
  constexpr std::ptrdiff_t most = packs_in_batch * pack_lanes;
  for (; begin < end; begin += most) {
    const std::ptrdiff_t last = end - begin < most ? end : begin + most;
    f(begin, last, int((last - begin + pack_lanes - 1) / pack_lanes));
  }
}

/// Places in a grid. Those outside are given the first cell, so that reading there does no harm.
struct PackPlace {
  PackIndex column, row;
  Pack east, north;
  PackMask inside;
};

SNOWSHED_INLINE PackPlace stored_place(const SlideView& s, const Lanes& l) {
  return {l.load(s.column), l.load(s.row), l.load(s.east), l.load(s.north),
          all_lanes};
}

/// See `Terrain::place`.
SNOWSHED_INLINE PackPlace place_of(const SlideView& s, const Pack& x, const Pack& y) {
  PackPlace p;
  Pack i = x * s.per_cell, j = y * s.per_cell;
  p.inside = (i >= 0.0) & (j >= 0.0) & (i < double(s.columns - 1)) & (j < double(s.rows - 1));
  i = select(p.inside, i, Pack{});
  j = select(p.inside, j, Pack{});
  p.column = __builtin_convertvector(i, PackIndex);
  p.row = __builtin_convertvector(j, PackIndex);
  p.east = i - __builtin_convertvector(p.column, Pack);
  p.north = j - __builtin_convertvector(p.row, Pack);
  return p;
}

/// The weights of the four nodes around, one row for each node.
struct BilinearWeights {
  alignas(pack_bytes) double w[4][pack_lanes];
  SNOWSHED_INLINE explicit BilinearWeights(const PackPlace& p) {
    const Pack west = 1.0 - p.east, south = 1.0 - p.north;
    store_pack(w[0], west * south);
    store_pack(w[1], p.east * south);
    store_pack(w[2], west * p.north);
    store_pack(w[3], p.east * p.north);
  }
};

/// For each place record(mean of the four nodes around by their bilinear weights, those nodes), and
/// these records taken apart.
template <class Record>
SNOWSHED_INLINE PackRecord records_at(const double* nodes, int columns, const PackPlace& p,
                                      const Record& record) {
  const BilinearWeights weights(p);
  const PackIndex first = p.row * columns + p.column;
  Quad rows[pack_lanes];
  for (int i = 0; i < pack_lanes; ++i) {
    const double* a = nodes + 4 * std::ptrdiff_t(first[i]);
    const double* b = a + 4 * std::ptrdiff_t(columns);
    const Quad n[4] = {load_row(a), load_row(a + 4), load_row(b), load_row(b + 4)};
    const Quad here = weights.w[0][i] * n[0] + weights.w[1][i] * n[1] + weights.w[2][i] * n[2] +
                      weights.w[3][i] * n[3];
    rows[i] = record(here, n);
  }
  return taken_apart(rows);
}

SNOWSHED_INLINE PackRecord flow_at(const SlideView& s, PackPlace p) {
  p.column -= s.flow_column;
  p.row -= s.flow_row;
  return records_at(s.flow, s.flow_columns, p,
                    [](const Quad& here, const Quad*) SNOWSHED_INLINE_LAMBDA { return here; });
}

/// The upward unit normal of a slope.
SNOWSHED_INLINE PackVec upward(const Pack& slope_x, const Pack& slope_y) {
  const Pack z = inverse_sqrt(Pack(1.0 + slope_x * slope_x + slope_y * slope_y));
  return {slope_x * z, slope_y * z, z};
}

/// The height of the ground and a normal. Known is where the south-west node of the cell is.
struct PackGround {
  Pack height;
  PackVec normal;
  PackMask known;
};
SNOWSHED_INLINE PackGround ground_at(const SlideView& s, const PackPlace& p) {
  const PackRecord r =
      records_at(s.ground, s.columns, p, [](const Quad& here, const Quad* n) SNOWSHED_INLINE_LAMBDA {
        return __builtin_shufflevector(here, n[0], 0, 1, 2, 4);
      });
  return {r.a, upward(r.b, r.c), r.d == r.d};
}
/// The same with the normal in the middle of the cell.
SNOWSHED_INLINE PackGround cell_ground(const SlideView& s, const PackPlace& p) {
  const PackRecord r =
      records_at(s.ground, s.columns, p, [](const Quad& here, const Quad* n) SNOWSHED_INLINE_LAMBDA {
        const Quad mean = 0.25 * (n[0] + n[1] + n[2] + n[3]);
        return __builtin_shufflevector(here, mean, 0, 5, 6, 7);
      });
  return {r.a, upward(r.b, r.c), all_lanes};
}

/// Points brought onto the ground along the normals of the cells they come through, up to five
/// times, as AvaFrame and SamosAT do it. They are not inside where they left the grid.
struct PackReprojection {
  Pack x, y;
  PackPlace on_ground;
};
SNOWSHED_INLINE PackReprojection reproject(const SlideView& s, Pack x, Pack y, Pack z) {
  PackPlace place = place_of(s, x, y);
  const PackIndex column = place.column, row = place.row;
  PackMask moving = place.inside;
  for (int k = 0; k < 5 && any_lane(moving); ++k) {
    const PackGround ground = cell_ground(s, place);
    const Pack distance = (ground.height - z) * ground.normal.z;
    x = select(moving, Pack(x + distance * ground.normal.x), x);
    y = select(moving, Pack(y + distance * ground.normal.y), y);
    z = select(moving, Pack(z + distance * ground.normal.z), z);
    place = place_of(s, x, y);  // unchanged where x and y are
    const PackIndex same = (place.column == column) & (place.row == row);
    moving &= place.inside & ~__builtin_convertvector(same, PackMask);
  }
  return {x, y, place};
}

/// Keeps places of particles and the normals of the ground there.
SNOWSHED_INLINE void store_place(const SlideView& s, const Lanes& l, const PackPlace& place,
                                 const PackVec& normal) {
  l.store(s.column, place.column);
  l.store(s.row, place.row);
  l.store(s.east, place.east);
  l.store(s.north, place.north);
  l.store(s.nx, s.ny, s.nz, normal);
}

SNOWSHED_VARIANT_END
