// Products of the equations' matrices with vectors.
#pragma once

#include "snowshed/methods/mps/kernels/row_packs.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

/// The sum of weight x over the neighbours of a row. Rows are short and their unknowns far apart in
/// memory, so gathering lanes costs more than four independent sums.
template <class T>
SNOWSHED_INLINE T sum_row(const PairRows& rows, const float* weight, const T* x, std::size_t row) {
  const std::size_t end = rows.first[row + 1];
  std::size_t e = rows.first[row];
  T sum[4] = {};
  for (; e + 4 <= end; e += 4) {
    SNOWSHED_UNROLL
    for (std::size_t k = 0; k < 4; ++k) sum[k] += T(weight[e + k]) * x[rows.index[e + k]];
  }
  for (; e < end; ++e) sum[0] += T(weight[e]) * x[rows.index[e]];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// q[row] = block[row] p[row] - sum of coupling * p[neighbour]; 0 if the block begins with zero.
/// `p` and `q` have a vector per particle, `block` a matrix by columns, and `coupling` a value per
/// pair.
template <int D>
SNOWSHED_INLINE void apply_row_to_velocities(const PairRows& rows, const float* coupling,
                                             const double* block, const double* p, double* q,
                                             std::size_t row) {
  const double *const b = block + row * D * D, *const own = p + row * D;
  double sum[2][D] = {};
  if (b[0] != 0) {
    const auto add = [&](double (&to)[D], std::size_t e) SNOWSHED_INLINE_LAMBDA {
      const double c = double(coupling[e]);
      const double* const other = p + std::size_t(rows.index[e]) * D;
      SNOWSHED_UNROLL
      for (int d = 0; d < D; ++d) to[d] -= c * other[d];
    };
    const std::size_t end = rows.first[row + 1];
    std::size_t e = rows.first[row];
    for (; e + 2 <= end; e += 2) {
      add(sum[0], e);
      add(sum[1], e + 1);
    }
    if (e < end) add(sum[0], e);
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d)
      for (int k = 0; k < D; ++k) sum[0][d] += b[k * D + d] * own[k];
  }
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) q[row * D + d] = sum[0][d] + sum[1][d];
}

SNOWSHED_MODULE_VARIANT_END
