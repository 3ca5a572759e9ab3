// Forces of the symmetric viscous stress. Pairs of particles resist the change of their separation
// in a frame that turns with the snow around them, so that a rotation of the snow costs nothing.
//
// A row is a particle. `turn` and `torque` have the antisymmetric components (a, b), a < b, of a
// matrix per particle; `spread` a matrix by columns.
#pragma once

#include "snowshed/methods/mps/kernels/rates.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

template <int D>
inline constexpr int turn_components = D * (D - 1) / 2;

/// Changes of velocity relative to a frame that turns with the mean of both particles' spins.
template <int D, class V>
SNOWSHED_INLINE void subtract_turn(const PairMotion<D>& pair, const double* turn, std::size_t row,
                                   V (&change)[D]) {
  constexpr int turns = turn_components<D>;
  const IndexPack<V> at = pair.index * turns;
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) change[d] = pair.change[d];
  int k = 0;
  SNOWSHED_UNROLL
  for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
  for (int b = a + 1; b < D; ++b, ++k) {
    const V spin = 0.5 * (gather<V>(turn + k, at) + turn[row * turns + std::size_t(k)]);
    change[a] -= spin * pair.separation[b];
    change[b] += spin * pair.separation[a];
  }
}

/// q[row] = block[row] p[row] - sum of t, where t is twice the coupling times the change of
/// velocity in the turning frame; torque[row] = -1/4 of the sum of t_a r_b - t_b r_a.
template <int D>
SNOWSHED_INLINE void sum_row_stresses(const PairRows& rows, const float* const* offset,
                                      const float* coupling, const double* block, const double* p,
                                      const double* turn, double* q, double* torque,
                                      std::size_t row) {
  using V = SimdPack<double>;
  constexpr int turns = turn_components<D>;
  V force[D] = {}, moment[turns] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const PairMotion<D> pair(rows, offset, p, row, pack);
    V t[D];
    subtract_turn<D>(pair, turn, row, t);
    const V twice = 2.0 * pack.load(coupling);
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      t[d] *= twice;
      force[d] += t[d];
    }
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
    for (int b = a + 1; b < D; ++b, ++k)
      moment[k] += t[a] * pair.separation[b] - t[b] * pair.separation[a];
  });
  const double* const m = block + row * D * D;
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) {
    double own = 0;
    for (int k = 0; k < D; ++k) own += m[k * D + d] * p[row * D + std::size_t(k)];
    q[row * D + std::size_t(d)] = m[0] != 0 ? own - sum_lanes(force[d]) : 0.0;
  }
  SNOWSHED_UNROLL
  for (int k = 0; k < turns; ++k)
    torque[row * turns + std::size_t(k)] = -0.25 * sum_lanes(moment[k]);
}

/// q[row] -= sum of slope * (spread[row] + spread[neighbour]) r, unless the block begins with zero.
/// It is the transpose of the sums by which the spins follow from the velocities.
template <int D>
SNOWSHED_INLINE void spread_row_torques(const PairRows& rows, const float* const* offset,
                                        const float* slope, const double* block,
                                        const double* spread, double* q, std::size_t row) {
  using V = SimdPack<double>;
  if (block[row * D * D] == 0) return;
  V force[D] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const IndexPack<V> at = pack.load_index(rows.index) * (D * D);
    const V s = pack.load(slope);
    SNOWSHED_UNROLL
    for (int b = 0; b < D; ++b) {
      const V weighted = s * pack.load(offset[b]);
      SNOWSHED_UNROLL
      for (int a = 0; a < D; ++a)
        force[a] += weighted * (gather<V>(spread + b * D + a, at) +
                                spread[row * D * D + std::size_t(b * D + a)]);
    }
  });
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) q[row * D + std::size_t(d)] -= sum_lanes(force[d]);
}

SNOWSHED_MODULE_VARIANT_END
