// The pressure of the snow around, as the default mode has it: along the ground, not along the map.
//
// A particle has the thickness h_k = sum_l (m_l / rho) W(r_kl), with the spiky kernel W and the
// distance r_kl in space, so that h is normal to the ground. Snow has the potential energy
// sum_k m_k g n_z h_k / 2, with the ground's normal n. What it exerts along the ground follows from
// it: two particles push each other with opposite forces (Monaghan 2005,
// doi:10.1088/0034-4885/68/8/R01). Where a particle has so few neighbours that the sum falls short of
// the integral, its pressure is raised by what is missing, at most twofold.
#pragma once

#include "snowshed/core/simd_math.hpp"
#include "snowshed/methods/slide/kernels/ground.hpp"
#include "snowshed/methods/slide/kernels/neighbours.hpp"

SNOWSHED_VARIANT_BEGIN

/// By how much the kernel's sum over few neighbours falls short of the pressure of snow, inverted. In
/// a triangular lattice with N particles within the kernel the sum is 1 - 5 N^-1.4 of the integral,
/// within a few percent for N above 10.
template <class V>
SNOWSHED_INLINE V few_neighbours(const V& particles_in_kernel) {
  const V power = 1.0 + expm1(V(-1.4 * log1p(V(particles_in_kernel - 1.0))));
  return 1.0 / max(broadcast<V>(0.5), V(1.0 - 5.0 * power));
}

/// Of entries in the order of cells.
SNOWSHED_INLINE void show_entries(const SlideView& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  using V = SimdPack<double>;
  constexpr int width = simd_width<double>;
  const double kernel_mass = 3.14159265358979323846 * s.cell * s.cell * s.density;  // kg per m
  for (std::ptrdiff_t e = begin; e < end; e += width) {
    const int count = end - e < width ? int(end - e) : width;
    V z, nz, thickness, mass;
    for (int lane = 0; lane < width; ++lane) {
      const std::ptrdiff_t at = e + (lane < count ? lane : 0);
      const std::uint32_t i = s.sorted_particle[at];
      z[lane] = s.z[i];
      nz[lane] = s.nz[i];
      thickness[lane] = s.thickness[i];
      mass[lane] = s.sorted_mass[at];
    }
    const V h = max(thickness, broadcast<V>(least_slide_thickness));
    store(s.sorted_z + e, z, count);
    store(s.sorted_pressing + e, V(nz * few_neighbours(V(kernel_mass * h / mass))), count);
  }
}

SNOWSHED_INLINE void surface_pressure_row(const SlideView& s, int row) {
  using V = SimdPack<double>;
  constexpr std::uint32_t width = simd_width<double>;
  const double factor = 0.5 * spiky_constant(s.cell) * s.gravity / s.density;
  V sx{}, sy{}, sz{};
  const auto add = [&](std::uint32_t k, std::uint32_t begin, std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    for (std::uint32_t e = begin; e < end; e += width) {
      const V dx = load_beyond<V>(s.sorted_x + e) - s.sorted_x[k];
      const V dy = load_beyond<V>(s.sorted_y + e) - s.sorted_y[k];
      const V dz = load_beyond<V>(s.sorted_z + e) - s.sorted_z[k];
      const V pressing = load_beyond<V>(s.sorted_pressing + e) + s.sorted_pressing[k];
      const V w = load_beyond<V>(s.sorted_mass + e) * pressing *
                  spiky_gradient(V(dx * dx + dy * dy + dz * dz), s.cell);
      const V counted = select(lane_numbers<V>() < double(end - e), w, V{});
      sx += counted * dx;
      sy += counted * dy;
      sz += counted * dz;
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
