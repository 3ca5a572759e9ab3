// The pressure of the snow around in the default mode: along the ground, pair by pair.
//
// A particle has the thickness h_k = sum_l (m_l / rho) W(r_kl), with the spiky kernel W and the
// distance r_kl in space, so that h is normal to the ground. Snow has the potential energy
// sum_k m_k g f_k h_k / 2, see columns.hpp. Its force along the ground is -m g grad(f h), by sums
// of pairs (Monaghan 2005, doi:10.1088/0034-4885/68/8/R01). On a plane two particles push each
// other with opposite forces. The neighbour's f takes the change of f along the ground into
// account, so that snow with a level surface has no force. Where a particle has so few neighbours
// that the sum falls short of the integral, its pressure is raised to correct this, at most
// twofold. The correction depends on h_k alone, so that it has a potential, too.
#pragma once

#include "snowshed/core/simd_math.hpp"
#include "snowshed/methods/slide/columns.hpp"
#include "snowshed/methods/slide/kernels/neighbours.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// See `few_neighbours` in kernel_api.hpp.
template <class V>
SNOWSHED_INLINE V raised_pressure(const V& neighbours) {
  const V log_neighbours = log1p(V(max(neighbours, broadcast<V>(1e-3)) - 1.0));
  const V more = 1.0 + expm1(V(-few_neighbours.power * log_neighbours));
  return min(broadcast<V>(2.0), V(1.0 + few_neighbours.factor * more));
}

/// Finds the number of neighbours, by mass, within the kernel of each of `count` particles.
template <int count>
SNOWSHED_INLINE void count_neighbours_of(const View& s, std::uint32_t first,
                                         const Neighbourhood& around) {
  using V = SimdPack<double>;
  V sum[2]{};
  for_each_neighbour(around, [&](std::uint32_t e, std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    const Neighbours<V> sources(s, e);
    const V mass = within(load_beyond<V>(s.sorted_mass + e), e, end);
    for (int k = 0; k < count; ++k) {
      const V square = max(Separation<V>(s, first + k, sources).square(), broadcast<V>(min_square));
      const V inside = max(V{}, V(s.cell - square * inverse_sqrt(square)));
      sum[k] += mass * inside * inside * inside;
    }
  });
  // Constant of the kernel, which is normalised over a disc.
  const double constant = 10 / (s.cell * s.cell * s.cell);
  const Quad sums = constant * sums_of(sum[0], sum[1], V{}, V{});
  for (int k = 0; k < count; ++k)
    s.sorted_pressure_factor[first + k] = sums[k] / s.sorted_mass[first + k];
}

/// Finds the factor on the pressure for the particles of a row.
SNOWSHED_INLINE void weigh_row(const View& s, int row) {
  for_each_neighbourhood(s, row,
                         [&](std::uint32_t e, auto count, const Neighbourhood& around)
                             SNOWSHED_INLINE_LAMBDA { count_neighbours_of<count>(s, e, around); });
  const std::uint32_t* cells = s.cell_begin + std::ptrdiff_t(row) * s.cell_columns;
  const std::ptrdiff_t begin = cells[0], end = cells[s.cell_columns];
  using V = SimdPack<double>;
  constexpr int width = simd_width<double>;
  for (std::ptrdiff_t e = begin; e < end; e += width) {
    const int count = end - e < width ? int(end - e) : width;
    V factor;
    for (int lane = 0; lane < width; ++lane) {
      const std::uint32_t i = s.sorted_particle[e + (lane < count ? lane : 0)];
      factor[lane] = column_factor(s.across_flow, s.nz[i], s.ux[i], s.uy[i], s.uz[i]);
    }
    store(s.sorted_column_mass + e, V(factor * load(s.sorted_mass + e, count)), count);
    store(s.sorted_pressure_factor + e, raised_pressure(load(s.sorted_pressure_factor + e, count)),
          count);
  }
}

template <int count>
SNOWSHED_INLINE void surface_pressure_on(const View& s, double factor, std::uint32_t first,
                                         const Neighbourhood& around) {
  using V = SimdPack<double>;
  V sx[2]{}, sy[2]{}, sz[2]{};
  for_each_neighbour(around, [&](std::uint32_t e, std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    const Neighbours<V> sources(s, e);
    const V mass = within(load_beyond<V>(s.sorted_column_mass + e), e, end);
    const V raised = load_beyond<V>(s.sorted_pressure_factor + e);
    for (int k = 0; k < count; ++k) {
      const Separation<V> separation(s, first + k, sources);
      const V pressing = mass * (raised + s.sorted_pressure_factor[first + k]);
      const V w = spiky_gradient(pressing, separation.square(), s.cell);
      sx[k] += w * separation.x;
      sy[k] += w * separation.y;
      sz[k] += w * separation.z;
    }
  });
  for (int k = 0; k < count; ++k) {
    const std::uint32_t i = s.sorted_particle[first + k];
    const double mass = s.sorted_mass[first + k];
    const Quad p = (factor * mass) * sums_of(sx[k], sy[k], sz[k], V{});
    const Quad normal{s.nx[i], s.ny[i], s.nz[i], 0};
    const double lift = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
    store_row(s.pressure_force + 4 * std::ptrdiff_t(i), p - lift * normal);
  }
}

SNOWSHED_INLINE void surface_pressure_row(const View& s, int row) {
  const double factor = 0.5 * spiky_constant(s.cell) * s.gravity / s.density;
  for_each_neighbourhood(
      s, row, [&](std::uint32_t e, auto count, const Neighbourhood& around) SNOWSHED_INLINE_LAMBDA {
        surface_pressure_on<count>(s, factor, e, around);
      });
}

SNOWSHED_MODULE_VARIANT_END
