// The pressure of the snow around, as the default mode has it: along the ground, not along the map.
//
// A particle has the thickness h_k = sum_l (m_l / rho) W(r_kl), with the spiky kernel W and the
// distance r_kl in space, so that h is normal to the ground. Snow has the potential energy
// sum_k m_k g n_z h_k / 2, with the ground's normal n. What it exerts along the ground follows from
// it: two particles push each other with opposite forces (Monaghan 2005,
// doi:10.1088/0034-4885/68/8/R01). Where a particle has so few neighbours that the sum falls short
// of the integral, its pressure is raised by what is missing, at most twofold. That depends on h_k
// alone, so that it has a potential, too.
#pragma once

#include "snowshed/core/simd_math.hpp"
#include "snowshed/methods/slide/kernels/neighbours.hpp"

SNOWSHED_VARIANT_BEGIN

/// See `few_neighbours` in kernel_api.hpp.
template <class V>
SNOWSHED_INLINE V raised_pressure(const V& seen) {
  const V log_seen = log1p(V(max(seen, broadcast<V>(1e-3)) - 1.0));
  const V more = 1.0 + expm1(V(-few_neighbours.power * log_seen));
  return min(broadcast<V>(2.0), V(1.0 + few_neighbours.factor * more));
}

/// Finds how many particles each particle of a row of cells sees, by mass, within its kernel.
SNOWSHED_INLINE void count_row(const SlideView& s, int row) {
  using V = SimdPack<double>;
  constexpr std::uint32_t width = simd_width<double>;
  const double constant = 10 / (s.cell * s.cell * s.cell);  // of the kernel, over a disc's area
  V sum{};
  const auto add = [&](std::uint32_t k, std::uint32_t begin,
                       std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    for (std::uint32_t e = begin; e < end; e += width) {
      const Way<V> way(s, k, e);
      const V square = max(way.square(), broadcast<V>(least_square));
      const V inside = max(V{}, V(s.cell - square * inverse_sqrt(square)));
      const V share = load_beyond<V>(s.sorted_mass + e) * inside * inside * inside;
      sum += within(share, e, end);
    }
  };
  for_each_neighbourhood(s, row, add, [&](std::uint32_t k) SNOWSHED_INLINE_LAMBDA {
    s.sorted_pressing[k] = constant * sum_of(sum) / s.sorted_mass[k];
    sum = V{};
  });
}

/// Turns these numbers into what pressure is multiplied by.
SNOWSHED_INLINE void weigh_entries(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  using V = SimdPack<double>;
  constexpr int width = simd_width<double>;
  for (std::ptrdiff_t e = begin; e < end; e += width) {
    const int count = end - e < width ? int(end - e) : width;
    V nz;
    for (int lane = 0; lane < width; ++lane)
      nz[lane] = s.nz[s.sorted_particle[e + (lane < count ? lane : 0)]];
    store(s.sorted_pressing + e, V(nz * raised_pressure(load(s.sorted_pressing + e, count))),
          count);
  }
}

SNOWSHED_INLINE void surface_pressure_row(const SlideView& s, int row) {
  using V = SimdPack<double>;
  constexpr std::uint32_t width = simd_width<double>;
  const double factor = 0.5 * spiky_constant(s.cell) * s.gravity / s.density;
  V sx{}, sy{}, sz{};
  const auto add = [&](std::uint32_t k, std::uint32_t begin,
                       std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    for (std::uint32_t e = begin; e < end; e += width) {
      const Way<V> way(s, k, e);
      const V pressing = load_beyond<V>(s.sorted_pressing + e) + s.sorted_pressing[k];
      const V w =
          load_beyond<V>(s.sorted_mass + e) * pressing * spiky_gradient(way.square(), s.cell);
      const V counted = within(w, e, end);
      sx += counted * way.x;
      sy += counted * way.y;
      sz += counted * way.z;
    }
  };
  for_each_neighbourhood(s, row, add, [&](std::uint32_t k) SNOWSHED_INLINE_LAMBDA {
    const std::uint32_t i = s.sorted_particle[k];
    const double px = factor * sum_of(sx), py = factor * sum_of(sy), pz = factor * sum_of(sz);
    const double lift = px * s.nx[i] + py * s.ny[i] + pz * s.nz[i];
    s.ax[i] += px - lift * s.nx[i];
    s.ay[i] += py - lift * s.ny[i];
    s.az[i] += pz - lift * s.nz[i];
    sx = sy = sz = V{};
  });
}

SNOWSHED_VARIANT_END
