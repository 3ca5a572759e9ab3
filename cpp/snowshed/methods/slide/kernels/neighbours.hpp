// Sums over the neighbours of a particle, with the spiky kernel (Mueller et al. 2003), as wide as a
// cell.
#pragma once

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_VARIANT_BEGIN

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

/// The way from a particle to some neighbours, in space, from entry e on in the order of cells.
template <class V>
struct Way {
  V x, y, z;

  SNOWSHED_INLINE Way(const SlideView& s, std::uint32_t from, std::uint32_t e)
      : x(load_beyond<V>(s.sorted_x + e) - s.sorted_x[from]),
        y(load_beyond<V>(s.sorted_y + e) - s.sorted_y[from]),
        z(load_beyond<V>(s.sorted_z + e) - s.sorted_z[from]) {}
  SNOWSHED_INLINE V square() const { return x * x + y * y + z * z; }
};

/// The values of those of the entries from e on that belong to a run up to `end`; 0 for others.
template <class V>
SNOWSHED_INLINE V within(const V& values, std::uint32_t e, std::uint32_t end) {
  return select(lane_numbers<V>() < double(end - e), values, V{});
}

/// (R - r)^2 / r from the square of the distance r: the gradient of the kernel with the radius R,
/// over the distance and but for its constant.
template <class V>
SNOWSHED_INLINE V spiky_gradient(const V& square, double radius) {
  const double least = 1e-3 * radius;
  const V s = max(square, broadcast<V>(least * least)), per_length = inverse_sqrt(s);
  const V inside = max(V{}, V(radius - s * per_length));
  return inside * inside * per_length;
}
SNOWSHED_INLINE double spiky_constant(double radius) {
  const double pi = 3.14159265358979323846;
  return -30 / (pi * radius * radius * radius * radius * radius);
}

template <class V>
SNOWSHED_INLINE double sum_of(const V& v) {
  if constexpr (sizeof(V) == 64) {
    Quad halves[2];
    std::memcpy(halves, &v, sizeof v);
    return sum_of(Quad(halves[0] + halves[1]));
  } else {
    double sum = 0;
    for (int i = 0; i < int(sizeof(V) / sizeof(double)); ++i) sum += v[i];
    return sum;
  }
}

/// Calls sum(entry, begin, end) for the particles of a row of cells, each with the three runs of
/// entries that its neighbours are in, and after them done(entry).
template <class Sum, class Done>
SNOWSHED_INLINE void for_each_neighbourhood(const SlideView& s, int row, const Sum& sum,
                                            const Done& done) {
  for (int column = 1; column + 1 < s.cell_columns; ++column) {
    const std::uint32_t* begin = s.cell_begin + std::ptrdiff_t(row) * s.cell_columns + column;
    for (std::uint32_t e = begin[0]; e < begin[1]; ++e) {
      for (int k = -1; k <= 1; ++k) {
        const std::uint32_t* neighbours = begin + std::ptrdiff_t(k) * s.cell_columns;
        sum(e, neighbours[-1], neighbours[2]);
      }
      done(e);
    }
  }
}

SNOWSHED_VARIANT_END
