// The forces of bonds.
#pragma once

#include "snowshed/methods/slide/kernels/cell_positions.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

/// The force of a bond is its modulus times its strain times its contact area, h L / sqrt 3.
SNOWSHED_INLINE PackMask store_bond_forces(const View& s, const Lanes& l) {
  const PackRecord r = transposed_to_packs([&](int i) SNOWSHED_INLINE_LAMBDA {
    const std::ptrdiff_t b = l.first + (i < l.count ? i : 0);
    const Quad first = load_row(s.predicted + 4 * std::ptrdiff_t(s.bond_first[b]));
    const Quad second = load_row(s.predicted + 4 * std::ptrdiff_t(s.bond_second[b]));
    return Quad(second - Quad{1, 1, 1, -1} * first);  // separation, and the sum of the thicknesses
  });
  const PackVec d{r.a, r.b, r.c};
  const Pack length = length_from(dot(d, d)), strain = length / l.load(s.rest_length) - 1.0;
  const PackMask acts = length > s.min_bond_length;
  const PackMask breaks = acts & (abs(strain) > s.max_strain);
  const double stiffness = s.bond_modulus * 0.5 / 1.7320508075688772;
  const Pack pull = select(PackMask(acts & ~breaks), Pack(stiffness * strain * r.d), Pack{});
  l.store_records(s.bond_force, {pull * d.x, pull * d.y, pull * d.z, Pack{}});
  l.store_flags(s.broken, breaks);
  return breaks;
}

/// The force of all bonds on a particle, N.
SNOWSHED_INLINE Quad bond_force_on(const View& s, std::ptrdiff_t i) {
  static constexpr double signs[2] = {1, -1};
  Quad sum{};
  if (!s.bond_begin) return sum;
  for (std::uint32_t e = s.bond_begin[i]; e < s.bond_begin[i + 1]; ++e) {
    const std::uint32_t entry = s.bond_entry[e];
    sum += signs[entry & 1] * load_row(s.bond_force + 4 * std::ptrdiff_t(entry >> 1));
  }
  return sum;
}

SNOWSHED_MODULE_VARIANT_END
