// The pressure of the snow around as AvaFrame 2.1 has it: the gradient of thickness on the map.
#pragma once

#include "snowshed/methods/slide/kernels/neighbours.hpp"

SNOWSHED_VARIANT_BEGIN

SNOWSHED_INLINE void map_pressure_row(const SlideView& s, int row) {
  using V = SimdPack<double>;
  constexpr std::uint32_t width = simd_width<double>;
  const double factor = spiky_constant(s.cell) * s.gravity / s.density;
  V gx{}, gy{};
  const auto add = [&](std::uint32_t k, std::uint32_t begin,
                       std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    for (std::uint32_t e = begin; e < end; e += width) {
      const V dx = load_beyond<V>(s.sorted_x + e) - s.sorted_x[k];
      const V dy = load_beyond<V>(s.sorted_y + e) - s.sorted_y[k];
      const V w = load_beyond<V>(s.sorted_mass + e) * spiky_gradient(V(dx * dx + dy * dy), s.cell);
      const V counted = within(w, e, end);
      gx += counted * dx;
      gy += counted * dy;
    }
  };
  for_each_neighbourhood(s, row, add, [&](std::uint32_t k) SNOWSHED_INLINE_LAMBDA {
    const std::uint32_t i = s.sorted_particle[k];
    s.ax[i] += factor * sum_of(gx);
    s.ay[i] += factor * sum_of(gy);
    gx = gy = V{};
  });
}

SNOWSHED_VARIANT_END
