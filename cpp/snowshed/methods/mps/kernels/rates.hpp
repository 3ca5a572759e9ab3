// Row sums over neighbours: gradients of pressure and velocity, approach speeds, and the shear rate
// at the midpoint of each pair.
//
// A row is a particle. `offset` (D arrays, m), `slope` (1/m2) and `rate` (1/s) have a value per
// pair. `value` and `share` (1) have a value per particle, `velocity` (m/s) and `sum` a vector, and
// `gradient` a matrix by columns, whose rows are components of the velocity.
#pragma once

#include "snowshed/methods/mps/kernels/row_packs.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

/// Separations of some pairs, and the change of velocity from the particle to its neighbours.
template <int D>
struct PairMotion {
  using V = SimdPack<double>;
  IndexPack<V> index;
  V separation[D], change[D];

  SNOWSHED_INLINE PairMotion(const PairRows& rows, const float* const* offset,
                             const double* velocity, std::size_t row, const RowPack<V>& pack)
      : index(pack.load_index(rows.index)) {
    const IndexPack<V> at = index * D;
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      separation[d] = pack.load(offset[d]);
      change[d] = gather<V>(velocity + d, at) - velocity[row * D + d];
    }
  }
};

/// gradient[row] = sum of slope * change x separation.
template <int D>
SNOWSHED_INLINE void sum_row_gradients(const PairRows& rows, const float* const* offset,
                                       const float* slope, const double* velocity, double* gradient,
                                       std::size_t row) {
  using V = SimdPack<double>;
  V sum[D * D] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const PairMotion<D> pair(rows, offset, velocity, row, pack);
    const V s = pack.load(slope);
    SNOWSHED_UNROLL
    for (int b = 0; b < D; ++b) {
      const V weighted = s * pair.separation[b];
      SNOWSHED_UNROLL
      for (int a = 0; a < D; ++a) sum[b * D + a] += pair.change[a] * weighted;
    }
  });
  SNOWSHED_UNROLL
  for (int k = 0; k < D * D; ++k) gradient[row * D * D + k] = sum_lanes(sum[k]);
}

/// sum[row] = sum of slope * (value[neighbour] + base) * separation; without values, sum of
/// slope * separation.
template <int D, bool with_values>
SNOWSHED_INLINE void sum_row_separations(const PairRows& rows, const float* const* offset,
                                         const float* slope, const double* value, double base,
                                         double* sum, std::size_t row) {
  using V = SimdPack<double>;
  V total[D] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    V factor = pack.load(slope);
    if constexpr (with_values) factor *= gather<V>(value, pack.load_index(rows.index)) + base;
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) total[d] += factor * pack.load(offset[d]);
  });
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) sum[row * D + std::size_t(d)] = sum_lanes(total[d]);
}

/// sum[row] = sum of share[neighbour] * max(0, -change . e) * e over the neighbours nearer than
/// `limit`; e is the direction of the separation.
template <int D>
SNOWSHED_INLINE void sum_row_approaches(const PairRows& rows, const float* const* offset,
                                        const double* velocity, const double* share, double limit,
                                        double* sum, std::size_t row) {
  using V = SimdPack<double>;
  V total[D] = {};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    const PairMotion<D> pair(rows, offset, velocity, row, pack);
    V square{}, along{};
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      square += pair.separation[d] * pair.separation[d];
      along -= pair.change[d] * pair.separation[d];
    }
    // Lanes beyond the row have no separation, and add nothing.
    const V none{}, approaching = select(square < limit * limit, max(along, none), none);
    const V factor = gather<V>(share, pair.index) * approaching / max(square, broadcast<V>(1e-30));
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) total[d] += factor * pair.separation[d];
  });
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) sum[row * D + std::size_t(d)] = sum_lanes(total[d]);
}

/// rate[pair] = |G + G^T| / sqrt(2), guaranteed only for pairs whose neighbour has the larger
/// index. G is the mean of both gradients, except that along the separation it is the change of
/// velocity. With `elastic`, a symmetric matrix per particle, the mean of both is added to G.
template <int D>
SNOWSHED_INLINE void find_pair_rates(const PairRows& rows, const float* const* offset,
                                     const double* velocity, const double* gradient,
                                     const double* elastic, float* rate, std::size_t row) {
  using V = SimdPack<double>;
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    std::uint32_t last = 0;  // neighbours need not be in order
    for (int k = 0; k < pack.count; ++k) {
      const std::uint32_t other = rows.index[pack.entry + std::size_t(k)];
      last = other > last ? other : last;
    }
    if (last < row) return;
    const PairMotion<D> pair(rows, offset, velocity, row, pack);
    const IndexPack<V> at = pair.index * (D * D);
    V mean[D * D], along[D], square{};
    SNOWSHED_UNROLL
    for (int k = 0; k < D * D; ++k)
      mean[k] = 0.5 * (gather<V>(gradient + k, at) + gradient[row * D * D + k]);
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) {
      along[a] = pair.change[a];
      SNOWSHED_UNROLL
      for (int b = 0; b < D; ++b) along[a] -= mean[b * D + a] * pair.separation[b];
      square += pair.separation[a] * pair.separation[a];
    }
    const V inverse = 1.0 / max(square, broadcast<V>(1e-30));
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) along[a] *= inverse;
    if (elastic) {
      SNOWSHED_UNROLL
      for (int k = 0; k < D * D; ++k)
        mean[k] += 0.5 * (gather<V>(elastic + k, at) + elastic[row * D * D + k]);
    }
    V sum{};  // |G + G^T|^2 / 2
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) {
      const V diagonal = mean[a * D + a] + along[a] * pair.separation[a];
      sum += 2 * diagonal * diagonal;
      SNOWSHED_UNROLL
      for (int b = 0; b < a; ++b) {
        const V shear = mean[a * D + b] + mean[b * D + a] + along[a] * pair.separation[b] +
                        along[b] * pair.separation[a];
        sum += shear * shear;
      }
    }
    pack.store(rate, sqrt(sum));
  });
}

SNOWSHED_MODULE_VARIANT_END
