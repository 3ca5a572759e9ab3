// A pack of particles: their positions in the cells of the ground, and the values of the ground at
// them.
#pragma once

#include "snowshed/core/simd_vec.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"
#include "snowshed/methods/slide/kernels/node_records.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

using PackVec = SimdVec<Pack>;

/// Smaller squares count as zero in roots.
inline constexpr double min_square = 1e-30;
SNOWSHED_INLINE Pack length_from(const Pack& square) {
  const Pack s = max(square, broadcast<Pack>(min_square));
  return s * inverse_sqrt(s);
}

/// Consecutive entries of an array, at most a pack; if there are fewer, the first one is repeated.
struct Lanes {
  std::ptrdiff_t first;
  int count;

  SNOWSHED_INLINE Pack load(const double* p) const { return load_pack<Pack>(p + first, count); }
  /// The lanes that hold an entry of their own.
  SNOWSHED_INLINE PackMask filled() const { return first_lanes<Pack>(count); }
  SNOWSHED_INLINE PackIndex load(const std::int32_t* p) const {
    return load_pack<PackIndex>(p + first, count);
  }
  SNOWSHED_INLINE PackVec load(const double* x, const double* y, const double* z) const {
    return {load(x), load(y), load(z)};
  }
  SNOWSHED_INLINE void store(double* p, const Pack& v) const { store_pack(p + first, v, count); }
  SNOWSHED_INLINE void store(std::int32_t* p, const PackIndex& v) const {
    store_pack(p + first, v, count);
  }
  SNOWSHED_INLINE void store_flags(char* p, const PackMask& set) const {
    if (!any_lane(set))
      std::memset(p + first, 0, std::size_t(count));
    else
      for (int i = 0; i < count; ++i) p[first + i] = set[i] != 0;
  }
  SNOWSHED_INLINE void store_records(double* p, const PackRecord& r) const {
    const PackRows rows = transposed_to_rows(r);
    if (count == pack_lanes)
      for (int i = 0; i < pack_lanes; ++i) store_row(p + 4 * (first + i), rows.of[i]);
    else
      for (int i = 0; i < count; ++i) store_row(p + 4 * (first + i), rows.of[i]);
  }
  SNOWSHED_INLINE void store(double* x, double* y, double* z, const PackVec& v) const {
    store(x, v.x);
    store(y, v.y);
    store(z, v.z);
  }
};

/// The k-th pack of a range.
SNOWSHED_INLINE Lanes lanes_of(std::ptrdiff_t begin, std::ptrdiff_t end, int k) {
  const std::ptrdiff_t first = begin + std::ptrdiff_t(k) * pack_lanes;
  return {first, first + pack_lanes <= end ? pack_lanes : int(end - first)};
}

/// Calls f(lanes) for the entries of a range.
template <class F>
SNOWSHED_INLINE void for_each_lanes(std::ptrdiff_t begin, std::ptrdiff_t end, const F& f) {
  for (; begin < end; begin += pack_lanes) f(lanes_of(begin, end, 0));
}

/// Number of packs that a kernel processes together. The phases of one pack depend on each other;
/// interleaving packs hides their latency.
inline constexpr int packs_in_batch = 64 / pack_lanes;

/// Calls f(begin, end, packs) for batches of a range.
template <class F>
SNOWSHED_INLINE void for_each_batch(std::ptrdiff_t begin, std::ptrdiff_t end, const F& f) {
  constexpr std::ptrdiff_t batch = packs_in_batch * pack_lanes;
  for (; begin < end; begin += batch) {
    const std::ptrdiff_t last = end - begin < batch ? end : begin + batch;
    f(begin, last, int((last - begin + pack_lanes - 1) / pack_lanes));
  }
}

/// Cells in a grid, and positions within them. Positions outside the grid get the first cell, so
/// that reading does no harm.
struct PackCellPosition {
  PackIndex column, row;
  Pack east, north;
  PackMask inside;
};

/// The cells of particles, and positions within them (0 to 1).
SNOWSHED_INLINE PackCellPosition stored_position(const View& s, const Lanes& l) {
  return {l.load(s.column), l.load(s.row), l.load(s.east), l.load(s.north), all_lanes};
}

/// See `Terrain::cell_position`.
SNOWSHED_INLINE PackCellPosition cell_position(const View& s, const Pack& x, const Pack& y) {
  PackCellPosition p;
  Pack i = x * s.per_cell, j = y * s.per_cell;
  p.inside = (i >= 0.0) & (j >= 0.0) & (i < double(s.columns - 1)) & (j < double(s.rows - 1));
  i = select(p.inside, i, Pack{});
  j = select(p.inside, j, Pack{});
  p.column = __builtin_convertvector(i, PackIndex);
  p.row = __builtin_convertvector(j, PackIndex);
  p.east = i - as_doubles(p.column);
  p.north = j - as_doubles(p.row);
  return p;
}

/// Interpolated records of a grid, see Interpolation.
template <Interpolation interpolation>
SNOWSHED_INLINE PackRecord records_at(const double* nodes, int columns, const PackCellPosition& p) {
  const Pack west = 1.0 - p.east, south = 1.0 - p.north;
  return records_of<interpolation>(
      nodes, columns, p.row * columns + p.column,
      {{west * south, p.east * south, west * p.north, p.east * p.north}});
}

/// Thickness (m) and velocity (m/s) of the snow.
SNOWSHED_INLINE PackRecord flow_at(const View& s, PackCellPosition p) {
  p.column -= s.flow_column;
  p.row -= s.flow_row;
  return records_at<Interpolation::bilinear>(s.flow, s.flow_columns, p);
}

/// The upward unit normal of a slope.
SNOWSHED_INLINE PackVec upward(const Pack& slope_x, const Pack& slope_y) {
  const Pack z = inverse_sqrt(Pack(1.0 + slope_x * slope_x + slope_y * slope_y));
  return {slope_x * z, slope_y * z, z};
}

/// The height of the ground and a normal. The ground is known if the south-west node of the cell
/// is.
struct PackGround {
  Pack height;
  PackVec normal;
  PackMask known;
};
SNOWSHED_INLINE PackGround ground_at(const View& s, const PackCellPosition& p) {
  const PackRecord r = records_at<Interpolation::bilinear_with_mask>(s.ground, s.columns, p);
  return {r.a, upward(r.b, r.c), r.d == r.d};
}
/// The same with the normal in the middle of the cell.
SNOWSHED_INLINE PackGround cell_ground(const View& s, const PackCellPosition& p) {
  const PackRecord r =
      records_at<Interpolation::bilinear_first_mean_others>(s.ground, s.columns, p);
  return {r.a, upward(r.b, r.c), all_lanes};
}

/// Points brought onto the ground along the normals of the cells they come through, up to five
/// times, as in AvaFrame and SamosAT. Points that left the grid are not inside.
struct PackReprojection {
  Pack x, y;
  PackCellPosition on_ground;
};
SNOWSHED_INLINE PackReprojection reproject(const View& s, Pack x, Pack y, Pack z,
                                           const PackMask& moves) {
  PackCellPosition position = cell_position(s, x, y);
  const PackIndex column = position.column, row = position.row;
  PackMask moving = moves & position.inside;
  for (int k = 0; k < 5 && any_lane(moving); ++k) {
    const PackGround ground = cell_ground(s, position);
    const Pack distance = (ground.height - z) * ground.normal.z;
    x = select(moving, Pack(x + distance * ground.normal.x), x);
    y = select(moving, Pack(y + distance * ground.normal.y), y);
    z = select(moving, Pack(z + distance * ground.normal.z), z);
    position = cell_position(s, x, y);  // unchanged where x and y are
    const PackIndex same = (position.column == column) & (position.row == row);
    moving &= position.inside & ~as_mask(same);
  }
  return {x, y, position};
}

/// Stores the cell positions of particles and the normals of the ground at them.
SNOWSHED_INLINE void store_position(const View& s, const Lanes& l, const PackCellPosition& position,
                                    const PackVec& normal) {
  l.store(s.column, position.column);
  l.store(s.row, position.row);
  l.store(s.east, position.east);
  l.store(s.north, position.north);
  l.store(s.nx, s.ny, s.nz, normal);
}

SNOWSHED_MODULE_VARIANT_END
