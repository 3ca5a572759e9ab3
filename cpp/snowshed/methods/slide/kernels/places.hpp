// Four particles at a time: where they lie on the ground, and what lies there.
#pragma once

#include "snowshed/core/simd_quad.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"

SNOWSHED_VARIANT_BEGIN

struct QuadVec {
  Quad x, y, z;
};
SNOWSHED_INLINE QuadVec operator+(const QuadVec& a, const QuadVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SNOWSHED_INLINE QuadVec operator-(const QuadVec& a, const QuadVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SNOWSHED_INLINE QuadVec operator*(const Quad& s, const QuadVec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
SNOWSHED_INLINE Quad dot(const QuadVec& a, const QuadVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SNOWSHED_INLINE QuadVec select(const QuadMask& mask, const QuadVec& a, const QuadVec& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Below it a square counts as zero where a root is taken.
inline constexpr double least_square = 1e-30;
SNOWSHED_INLINE Quad length_from(const Quad& square) {
  const Quad s = max(square, broadcast<Quad>(least_square));
  return s * inverse_sqrt(s);
}

/// Up to four neighbouring entries of an array; where there are fewer the first is repeated.
struct Lanes {
  std::ptrdiff_t first;
  int count;

  SNOWSHED_INLINE Quad load(const double* p) const {
    p += first;
    if (count == 4) return load_row(p);
    Quad v = broadcast<Quad>(p[0]);
    for (int i = 1; i < count; ++i) v[i] = p[i];
    return v;
  }
  SNOWSHED_INLINE QuadIndex load(const std::int32_t* p) const {
    p += first;
    QuadIndex v;
    for (int i = 0; i < 4; ++i) v[i] = p[i < count ? i : 0];
    return v;
  }
  SNOWSHED_INLINE QuadVec load(const double* x, const double* y, const double* z) const {
    return {load(x), load(y), load(z)};
  }
  SNOWSHED_INLINE void store(double* p, const Quad& v) const {
    p += first;
    if (count == 4)
      store_row(p, v);
    else
      for (int i = 0; i < count; ++i) p[i] = v[i];
  }
  SNOWSHED_INLINE void store(std::int32_t* p, const QuadIndex& v) const {
    for (int i = 0; i < count; ++i) p[first + i] = v[i];
  }
  SNOWSHED_INLINE void store(double* x, double* y, double* z, const QuadVec& v) const {
    store(x, v.x);
    store(y, v.y);
    store(z, v.z);
  }
};

/// Calls f(lanes) for the entries of a range.
template <class F>
SNOWSHED_INLINE void for_each_lanes(std::ptrdiff_t begin, std::ptrdiff_t end, const F& f) {
  for (std::ptrdiff_t i = begin; i < end; i += 4) f(Lanes{i, i + 4 <= end ? 4 : int(end - i)});
}

/// Places in a grid. Those outside are given the first cell, so that reading there does no harm.
struct QuadPlace {
  QuadIndex column, row;
  Quad east, north;
  QuadMask inside;
};

SNOWSHED_INLINE QuadPlace stored_place(const SlideView& s, const Lanes& l) {
  return {l.load(s.column), l.load(s.row), l.load(s.east), l.load(s.north),
          QuadMask{-1, -1, -1, -1}};
}

/// See `Terrain::place`.
SNOWSHED_INLINE QuadPlace place_of(const SlideView& s, const Quad& x, const Quad& y) {
  QuadPlace p;
  Quad i = x * s.per_cell, j = y * s.per_cell;
  p.inside = (i >= 0.0) & (j >= 0.0) & (i < double(s.columns - 1)) & (j < double(s.rows - 1));
  i = select(p.inside, i, Quad{});
  j = select(p.inside, j, Quad{});
  p.column = __builtin_convertvector(i, QuadIndex);
  p.row = __builtin_convertvector(j, QuadIndex);
  p.east = i - __builtin_convertvector(p.column, Quad);
  p.north = j - __builtin_convertvector(p.row, Quad);
  return p;
}

/// The weights of the four nodes around, one row for each lane.
struct BilinearWeights {
  alignas(32) double w[4][4];  // [node][lane]
  SNOWSHED_INLINE explicit BilinearWeights(const QuadPlace& p) {
    const Quad west = 1.0 - p.east, south = 1.0 - p.north;
    store_row(w[0], west * south);
    store_row(w[1], p.east * south);
    store_row(w[2], west * p.north);
    store_row(w[3], p.east * p.north);
  }
};

/// Four values of each lane.
struct QuadRecord {
  Quad a, b, c, d;
};

/// Records of a grid, bilinear between the nodes.
SNOWSHED_INLINE QuadRecord interpolated(const double* nodes, int columns, const QuadPlace& p) {
  const BilinearWeights weights(p);
  Quad rows[4];
  for (int i = 0; i < 4; ++i) {
    const double* a = nodes + 4 * (std::ptrdiff_t(p.row[i]) * columns + p.column[i]);
    const double* b = a + 4 * std::ptrdiff_t(columns);
    rows[i] = weights.w[0][i] * load_row(a) + weights.w[1][i] * load_row(a + 4) +
              weights.w[2][i] * load_row(b) + weights.w[3][i] * load_row(b + 4);
  }
  transpose(rows[0], rows[1], rows[2], rows[3]);
  return {rows[0], rows[1], rows[2], rows[3]};
}

SNOWSHED_INLINE QuadRecord flow_at(const SlideView& s, QuadPlace p) {
  p.column -= s.flow_column;
  p.row -= s.flow_row;
  return interpolated(s.flow, s.flow_columns, p);
}

/// The upward unit normal of a slope.
SNOWSHED_INLINE QuadVec upward(const Quad& slope_x, const Quad& slope_y) {
  const Quad z = inverse_sqrt(Quad(1.0 + slope_x * slope_x + slope_y * slope_y));
  return {slope_x * z, slope_y * z, z};
}

/// Height of the ground, and the normal in the middle of the cell.
struct CellGround {
  Quad height;
  QuadVec normal;
};
SNOWSHED_INLINE CellGround cell_ground(const SlideView& s, const QuadPlace& p) {
  const BilinearWeights weights(p);
  Quad rows[4];
  for (int i = 0; i < 4; ++i) {
    const double* a = s.ground + 4 * (std::ptrdiff_t(p.row[i]) * s.columns + p.column[i]);
    const double* b = a + 4 * std::ptrdiff_t(s.columns);
    const Quad n0 = load_row(a), n1 = load_row(a + 4), n2 = load_row(b), n3 = load_row(b + 4);
    const Quad here =
        weights.w[0][i] * n0 + weights.w[1][i] * n1 + weights.w[2][i] * n2 + weights.w[3][i] * n3;
    const Quad mean = 0.25 * (n0 + n1 + n2 + n3);
    rows[i] = __builtin_shufflevector(here, mean, 0, 5, 6, 7);
  }
  transpose(rows[0], rows[1], rows[2], rows[3]);
  return {rows[0], upward(rows[1], rows[2])};
}

/// Whether the south-west node of a cell is known.
SNOWSHED_INLINE QuadMask is_known(const SlideView& s, const QuadPlace& p) {
  Quad height;
  for (int i = 0; i < 4; ++i)
    height[i] = s.ground[4 * (std::ptrdiff_t(p.row[i]) * s.columns + p.column[i])];
  return height == height;
}

/// Points brought onto the ground along the normals of the cells they come through, up to five
/// times, as AvaFrame and SamosAT do it. They are not inside where they left the grid.
struct QuadReprojection {
  Quad x, y;
  QuadPlace on_ground;
};
SNOWSHED_INLINE QuadReprojection reproject(const SlideView& s, Quad x, Quad y, Quad z) {
  QuadPlace place = place_of(s, x, y);
  const QuadIndex column = place.column, row = place.row;
  QuadMask moving = place.inside;
  for (int k = 0; k < 5 && any(moving); ++k) {
    const CellGround ground = cell_ground(s, place);
    const Quad distance = (ground.height - z) * ground.normal.z;
    x = select(moving, Quad(x + distance * ground.normal.x), x);
    y = select(moving, Quad(y + distance * ground.normal.y), y);
    z = select(moving, Quad(z + distance * ground.normal.z), z);
    place = place_of(s, x, y);  // unchanged where x and y are
    const QuadIndex same = (place.column == column) & (place.row == row);
    moving &= place.inside & ~__builtin_convertvector(same, QuadMask);
  }
  return {x, y, place};
}

/// Keeps places of particles and the normals of the ground there.
SNOWSHED_INLINE void store_place(const SlideView& s, const Lanes& l, const QuadPlace& place,
                                 const QuadVec& normal) {
  l.store(s.column, place.column);
  l.store(s.row, place.row);
  l.store(s.east, place.east);
  l.store(s.north, place.north);
  l.store(s.nx, s.ny, s.nz, normal);
}

SNOWSHED_VARIANT_END
