// What particles do to each other: pressure of the snow around, and bonds.
#pragma once

#include <cmath>

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_VARIANT_BEGIN

/// The sum over neighbours of mass times the gradient of the spiky kernel, but for its constant.
template <class V>
struct KernelGradient {
  V x{}, y{};
};

/// The number of each lane.
template <class V>
SNOWSHED_INLINE V lane_numbers() {
  V v;
  for (int i = 0; i < int(sizeof(V) / sizeof(double)); ++i) v[i] = i;
  return v;
}

/// Adds a run of neighbours, [begin, end) in the order of cells. It reads beyond the run, but
/// counts only what belongs to it.
template <class V>
SNOWSHED_INLINE void add_run(const SlideView& s, std::uint32_t begin, std::uint32_t end, double x,
                             double y, KernelGradient<V>& sum) {
  constexpr std::uint32_t width = sizeof(V) / sizeof(double);
  static_assert(width <= sorted_padding, "lanes must not read beyond the arrays");
  const double least = 1e-3 * s.cell;
  for (std::uint32_t e = begin; e < end; e += width) {
    V px, py, mass;
    std::memcpy(&px, s.sorted_x + e, sizeof px);
    std::memcpy(&py, s.sorted_y + e, sizeof py);
    std::memcpy(&mass, s.sorted_mass + e, sizeof mass);
    const V dx = px - x, dy = py - y;
    const V square = max(V(dx * dx + dy * dy), broadcast<V>(least * least));
    const V per_length = inverse_sqrt(square);
    const V inside = max(V{}, V(s.cell - square * per_length));
    const V weight =
        select(lane_numbers<V>() < double(end - e), V(mass * inside * inside * per_length), V{});
    sum.x += weight * dx;
    sum.y += weight * dy;
  }
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

/// Spiky kernel (Mueller et al. 2003) as wide as a cell, in two dimensions.
SNOWSHED_INLINE void pressure_row(const SlideView& s, int row) {
  using V = SimdPack<double>;
  const double pi = 3.14159265358979323846, c = s.cell;
  const double factor = -30 / (pi * c * c * c * c * c) * s.gravity / s.density;
  for (int column = 1; column + 1 < s.cell_columns; ++column) {
    const std::uint32_t* begin = s.cell_begin + std::ptrdiff_t(row) * s.cell_columns + column;
    for (std::uint32_t e = begin[0]; e < begin[1]; ++e) {
      KernelGradient<V> gradient;
      for (int k = -1; k <= 1; ++k) {
        const std::uint32_t* neighbours = begin + std::ptrdiff_t(k) * s.cell_columns;
        add_run<V>(s, neighbours[-1], neighbours[2], s.sorted_x[e], s.sorted_y[e], gradient);
      }
      const std::uint32_t i = s.sorted_particle[e];
      s.ax[i] += factor * sum_of(gradient.x);
      s.ay[i] += factor * sum_of(gradient.y);
    }
  }
}

/// The force of a bond is its modulus times its strain times its contact area, h L / sqrt 3.
SNOWSHED_INLINE QuadMask stretch_lanes(const SlideView& s, const Lanes& l) {
  Quad rows[4];
  for (int i = 0; i < 4; ++i) {
    const std::ptrdiff_t b = l.first + (i < l.count ? i : 0);
    const Quad first = load_row(s.predicted + 4 * std::ptrdiff_t(s.bond_first[b]));
    const Quad second = load_row(s.predicted + 4 * std::ptrdiff_t(s.bond_second[b]));
    rows[i] = __builtin_shufflevector(Quad(second - first), Quad(second + first), 0, 1, 2, 7);
  }
  transpose(rows[0], rows[1], rows[2], rows[3]);
  const QuadVec d{rows[0], rows[1], rows[2]};
  const Quad length = length_from(dot(d, d)), strain = length / l.load(s.rest_length) - 1.0;
  const QuadMask acts = length > s.min_bond_length;
  const QuadMask breaks = acts & (abs(strain) > s.max_strain);
  const double stiffness = s.bond_modulus * 0.5 / 1.7320508075688772;
  const Quad pull = select(QuadMask(acts & ~breaks), Quad(stiffness * strain * rows[3]), Quad{});
  rows[0] = pull * d.x;
  rows[1] = pull * d.y;
  rows[2] = pull * d.z;
  rows[3] = Quad{};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  for (int i = 0; i < l.count; ++i) {
    store_row(s.bond_force + 4 * (l.first + i), rows[i]);
    s.broken[l.first + i] = breaks[i] != 0;
  }
  return breaks;
}

SNOWSHED_INLINE void pull_particle(const SlideView& s, std::ptrdiff_t i) {
  Quad sum{};
  for (std::uint32_t e = s.bond_begin[i]; e < s.bond_begin[i + 1]; ++e) {
    const std::uint32_t entry = s.bond_entry[e];
    const double sign = 1 - 2 * double(entry & 1);
    sum += sign * load_row(s.bond_force + 4 * std::ptrdiff_t(entry >> 1));
  }
  const double per_mass = 1 / s.mass[i];
  s.ax[i] += per_mass * sum[0];
  s.ay[i] += per_mass * sum[1];
  s.az[i] += per_mass * sum[2];
}

SNOWSHED_VARIANT_END
