// The pressure of the snow around as in AvaFrame 2.1: the gradient of thickness on the map.
#pragma once

#include "snowshed/methods/slide/kernels/neighbours.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

template <int count>
SNOWSHED_INLINE void map_pressure_on(const View& s, double factor, std::uint32_t first,
                                     const Neighbourhood& around) {
  using V = SimdPack<double>;
  V gx[2]{}, gy[2]{};
  for_each_neighbour(around, [&](std::uint32_t e, std::uint32_t end) SNOWSHED_INLINE_LAMBDA {
    const V x = load_beyond<V>(s.sorted_x + e), y = load_beyond<V>(s.sorted_y + e);
    const V mass = within(load_beyond<V>(s.sorted_mass + e), e, end);
    for (int k = 0; k < count; ++k) {
      const V dx = x - s.sorted_x[first + k], dy = y - s.sorted_y[first + k];
      const V w = spiky_gradient(mass, V(dx * dx + dy * dy), s.cell);
      gx[k] += w * dx;
      gy[k] += w * dy;
    }
  });
  const Quad sums = factor * sums_of(gx[0], gy[0], gx[1], gy[1]);
  for (int k = 0; k < count; ++k) {
    const double mass = s.sorted_mass[first + k];
    store_row(s.pressure_force + 4 * std::ptrdiff_t(s.sorted_particle[first + k]),
              Quad{mass * sums[2 * k], mass * sums[2 * k + 1], 0, 0});
  }
}

SNOWSHED_INLINE void map_pressure_row(const View& s, int row) {
  const double factor = spiky_constant(s.cell) * s.gravity / s.density;
  for_each_neighbourhood(
      s, row, [&](std::uint32_t e, auto count, const Neighbourhood& around) SNOWSHED_INLINE_LAMBDA {
        map_pressure_on<count>(s, factor, e, around);
      });
}

SNOWSHED_MODULE_VARIANT_END
