// Sums over the neighbours of a particle, with the spiky kernel (Mueller et al. 2003), as wide as a
// cell.
#pragma once

#include <type_traits>

#include "snowshed/core/angles.hpp"
#include "snowshed/methods/slide/kernels/cell_positions.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// The number of each lane.
template <class V>
SNOWSHED_INLINE V lane_numbers() {
  V v;
  for (int i = 0; i < int(sizeof(V) / sizeof(double)); ++i) v[i] = i;
  return v;
}

template <class V>
SNOWSHED_INLINE V load_beyond(const double* p) {
  static_assert(sizeof(V) / sizeof(double) <= sorted_padding, "lanes must not read beyond arrays");
  V v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

/// Positions of some neighbours, from entry e on in the order of cells.
template <class V>
struct Neighbours {
  V x, y, z;

  SNOWSHED_INLINE Neighbours(const View& s, std::uint32_t e)
      : x(load_beyond<V>(s.sorted_x + e)),
        y(load_beyond<V>(s.sorted_y + e)),
        z(load_beyond<V>(s.sorted_z + e)) {}
};
/// Separation of the neighbours from a particle.
template <class V>
struct Separation {
  V x, y, z;

  SNOWSHED_INLINE Separation(const View& s, std::uint32_t from, const Neighbours<V>& to)
      : x(to.x - s.sorted_x[from]), y(to.y - s.sorted_y[from]), z(to.z - s.sorted_z[from]) {}
  SNOWSHED_INLINE V square() const { return x * x + y * y + z * z; }
};

/// The values of entries from e on; 0 for entries beyond the run, which goes up to `end`.
template <class V>
SNOWSHED_INLINE V within(const V& values, std::uint32_t e, std::uint32_t end) {
  return select(lane_numbers<V>() < double(end - e), values, V{});
}

/// Returns weight (R - r)^2 / r from the square of the distance r; 0 if r is not less than the
/// radius R. Without its constant, this is the gradient of the kernel, divided by r.
template <class V>
SNOWSHED_INLINE V spiky_gradient(const V& weight, const V& square, double radius) {
  const double min_distance = 1e-3 * radius, max_square = radius * radius;
  const V s = max(square, broadcast<V>(min_distance * min_distance));
  const V gradient = (max_square + s) * inverse_sqrt(s) - 2 * radius;
  return select(s < max_square, V(weight * gradient), V{});
}
SNOWSHED_INLINE double spiky_constant(double radius) {
  return -30 / (pi * radius * radius * radius * radius * radius);
}

/// The sums over the lanes of four packs.
template <class V>
SNOWSHED_INLINE Quad sums_of(const V& a, const V& b, const V& c, const V& d) {
  if constexpr (sizeof(V) == 64) {
    const auto folded = [](const V& v) SNOWSHED_INLINE_LAMBDA {
      return Quad(__builtin_shufflevector(v, v, 0, 1, 2, 3) +
                  __builtin_shufflevector(v, v, 4, 5, 6, 7));
    };
    return sums_of<Quad>(folded(a), folded(b), folded(c), folded(d));
  } else if constexpr (sizeof(V) == 32) {
    Quad rows[4] = {a, b, c, d};
    transpose(rows);
    return (rows[0] + rows[1]) + (rows[2] + rows[3]);
  } else {
    return Quad{a[0] + a[1], b[0] + b[1], c[0] + c[1], d[0] + d[1]};
  }
}

/// A run of entries, in the order of cells.
struct EntryRun {
  std::uint32_t begin, end;
};
/// The runs that hold the neighbours of a cell's particles.
using Neighbourhood = EntryRun[3];

/// Calls visit(e, n, neighbourhood) for the particles of each cell in a row: for the entry e, and
/// for the next one, too, if n is Two. Two particles together share the values that are read.
using One = std::integral_constant<int, 1>;
using Two = std::integral_constant<int, 2>;
template <class Visit>
SNOWSHED_INLINE void for_each_neighbourhood(const View& s, int row, const Visit& visit) {
  for (int column = 1; column + 1 < s.cell_columns; ++column) {
    const std::uint32_t* begin = s.cell_begin + std::ptrdiff_t(row) * s.cell_columns + column;
    std::uint32_t e = begin[0];
    const std::uint32_t end = begin[1];
    if (e == end) continue;
    Neighbourhood around;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t* neighbours = begin + std::ptrdiff_t(k - 1) * s.cell_columns;
      around[k] = {neighbours[-1], neighbours[2]};
    }
    for (; e + 1 < end; e += 2) visit(e, Two(), around);
    if (e < end) visit(e, One(), around);
  }
}

/// Calls add(e, end) for packs of entries of a neighbourhood, from e on, in a run up to `end`.
template <class Add>
SNOWSHED_INLINE void for_each_neighbour(const Neighbourhood& around, const Add& add) {
  constexpr std::uint32_t width = simd_width<double>;
  for (int k = 0; k < 3; ++k)
    for (std::uint32_t e = around[k].begin; e < around[k].end; e += width) add(e, around[k].end);
}

SNOWSHED_MODULE_VARIANT_END
