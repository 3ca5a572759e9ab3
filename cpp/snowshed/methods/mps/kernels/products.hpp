// Products of the equations' matrices with vectors.
#pragma once

#include "snowshed/methods/mps/kernels/row_packs.hpp"

SNOWSHED_VARIANT_BEGIN

/// The sum of weight x over the neighbours of a row.
template <class V>
SNOWSHED_INLINE Scalar<V> sum_row(const PairRows& rows, const float* weight, const Scalar<V>* x,
                                  std::size_t row) {
  V sum{};
  for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
    sum += pack.load(weight) * gather<V>(x, pack.load_index(rows.index));
  });
  return sum_lanes(sum);
}

template <int D>
SNOWSHED_INLINE void apply_row_to_velocities(const PairRows& rows, const float* coupling,
                                             const double* block, const double* p, double* q,
                                             std::size_t row) {
  using V = SimdPack<double>;
  const double *const b = block + row * D * D, *const own = p + row * D;
  double result[D] = {};
  if (b[0] != 0) {
    V sum[D] = {};
    for_each_pack<V>(rows, row, [&](const RowPack<V>& pack) SNOWSHED_INLINE_LAMBDA {
      const V c = pack.load(coupling);
      const IndexPack<V> at = pack.load_index(rows.index) * D;
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) sum[d] += c * gather<V>(p + d, at);
    });
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      for (int k = 0; k < D; ++k) result[d] += b[k * D + d] * own[k];
      result[d] -= sum_lanes(sum[d]);
    }
  }
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) q[row * D + d] = result[d];
}

SNOWSHED_VARIANT_END
