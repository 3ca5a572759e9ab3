// Forces of the symmetric stress. Pairs of particles resist the change of their separation in a
// frame that turns with the snow around them, so that a rotation of the snow costs nothing.
//
// A row is a particle. `turn` and `torque` have the antisymmetric components (a, b), a < b, of a
// matrix per particle; `lever` and `far_lever` have a vector per pair. A product with the matrix of
// the viscous equation has three passes: the turns of the particles, the forces and torques of the
// pairs, and the forces of the torques. As in products.hpp, sums of single pairs are faster than
// packs.
#pragma once

#include "snowshed/methods/mps/kernels/rates.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)

template <int D>
inline constexpr int turn_components = D * (D - 1) / 2;

/// Sums of N numbers over the pairs of a row: add(sum, pair) for each pair, in two partial sums.
template <int N, class Add>
SNOWSHED_INLINE void sum_pairs(const PairRows& rows, std::size_t row, double (&sum)[N],
                               const Add& add) {
  double other[N] = {};
  const std::size_t end = rows.first[row + 1];
  std::size_t e = rows.first[row];
  for (; e + 2 <= end; e += 2) {
    add(sum, e);
    add(other, e + 1);
  }
  if (e < end) add(sum, e);
  SNOWSHED_UNROLL
  for (int k = 0; k < N; ++k) sum[k] += other[k];
}

/// turn[row] = sum of u_a l_b - u_b l_a, where u is the change of p and l the pair's lever.
template <int D>
SNOWSHED_INLINE void sum_row_turns(const PairRows& rows, const float* lever, const double* p,
                                   double* turn, std::size_t row) {
  constexpr int turns = turn_components<D>;
  const double* const own = p + row * D;
  double sum[turns] = {};
  sum_pairs(rows, row, sum, [&](double (&to)[turns], std::size_t e) SNOWSHED_INLINE_LAMBDA {
    const double* const other = p + std::size_t(rows.index[e]) * D;
    const float* const l = lever + e * D;
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
    for (int b = a + 1; b < D; ++b, ++k)
      to[k] += (other[a] - own[a]) * double(l[b]) - (other[b] - own[b]) * double(l[a]);
  });
  SNOWSHED_UNROLL
  for (int k = 0; k < turns; ++k) turn[row * turns + std::size_t(k)] = sum[k];
}

/// Adds a force and the components t_a r_b - t_b r_a of its moment to a sum.
template <int D>
SNOWSHED_INLINE void add_force_and_moment(const double (&t)[D], const double (&r)[D],
                                          double (&sum)[D + turn_components<D>]) {
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) sum[d] += t[d];
  int k = D;
  SNOWSHED_UNROLL
  for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
  for (int b = a + 1; b < D; ++b, ++k) sum[k] += t[a] * r[b] - t[b] * r[a];
}

/// q[row] = block[row] p[row] - sum of t, or 0 if the block begins with zero. t is twice the
/// coupling times the change of p relative to a frame that turns with the mean of both particles'
/// turns. torque[row] = -1/4 of the sum of t_a r_b - t_b r_a.
template <int D>
SNOWSHED_INLINE void sum_row_stresses(const PairRows& rows, const float* const* offset,
                                      const float* coupling, const double* block, const double* p,
                                      const double* turn, double* q, double* torque,
                                      std::size_t row) {
  constexpr int turns = turn_components<D>;
  const double *const own = p + row * D, *const own_turn = turn + row * turns;
  double sum[D + turns] = {};
  sum_pairs(rows, row, sum, [&](double (&to)[D + turns], std::size_t e) SNOWSHED_INLINE_LAMBDA {
    const std::size_t j = rows.index[e];
    const double c = double(coupling[e]);
    double r[D], t[D];
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) {
      r[d] = double(offset[d][e]);
      t[d] = 2 * (p[j * D + std::size_t(d)] - own[d]);
    }
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
    for (int b = a + 1; b < D; ++b, ++k) {
      const double both = turn[j * turns + std::size_t(k)] + own_turn[k];
      t[a] -= both * r[b];
      t[b] += both * r[a];
    }
    SNOWSHED_UNROLL
    for (int d = 0; d < D; ++d) t[d] *= c;
    add_force_and_moment<D>(t, r, to);
  });
  const double* const m = block + row * D * D;
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) {
    double product = 0;
    for (int k = 0; k < D; ++k) product += m[k * D + d] * own[k];
    q[row * D + std::size_t(d)] = m[0] != 0 ? product - sum[d] : 0.0;
  }
  SNOWSHED_UNROLL
  for (int k = 0; k < turns; ++k) torque[row * turns + std::size_t(k)] = -0.25 * sum[D + k];
}

/// q[row] -= 2 (T[row] l + sum of T[neighbour] m), unless the block begins with zero. T is the
/// antisymmetric matrix of a torque, l the sum of the row's levers, and m the pair's far lever. It
/// is the transpose of sum_row_turns.
template <int D>
SNOWSHED_INLINE void spread_row_torques(const PairRows& rows, const float* far_lever,
                                        const double* lever_sum, const double* block,
                                        const double* torque, double* q, std::size_t row) {
  constexpr int turns = turn_components<D>;
  if (block[row * D * D] == 0) return;
  double sum[D] = {};
  const auto add = [](double (&to)[D], const double* t, const auto* l) SNOWSHED_INLINE_LAMBDA {
    int k = 0;
    SNOWSHED_UNROLL
    for (int a = 0; a < D; ++a) SNOWSHED_UNROLL
    for (int b = a + 1; b < D; ++b, ++k) {
      to[a] += t[k] * double(l[b]);
      to[b] -= t[k] * double(l[a]);
    }
  };
  sum_pairs(rows, row, sum, [&](double (&to)[D], std::size_t e) SNOWSHED_INLINE_LAMBDA {
    add(to, torque + std::size_t(rows.index[e]) * turns, far_lever + e * D);
  });
  add(sum, torque + row * turns, lever_sum + row * D);
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) q[row * D + std::size_t(d)] -= 2 * sum[d];
}

/// q[row] = minus the sum of t, or 0 if the block begins with zero; t is the coupling times
/// (tensor[row] + tensor[neighbour]) r. torque[row] = -1/4 of the sum of t_a r_b - t_b r_a.
/// `tensor` is a matrix per particle, by columns.
template <int D>
SNOWSHED_INLINE void sum_row_tensors(const PairRows& rows, const float* const* offset,
                                     const float* coupling, const double* block,
                                     const double* tensor, double* q, double* torque,
                                     std::size_t row) {
  constexpr int turns = turn_components<D>;
  const double* const own = tensor + row * D * D;
  double sum[D + turns] = {};
  sum_pairs(rows, row, sum, [&](double (&to)[D + turns], std::size_t e) SNOWSHED_INLINE_LAMBDA {
    const double* const other = tensor + std::size_t(rows.index[e]) * D * D;
    const double c = double(coupling[e]);
    double r[D], t[D] = {};
    SNOWSHED_UNROLL
    for (int b = 0; b < D; ++b) {
      r[b] = double(offset[b][e]);
      SNOWSHED_UNROLL
      for (int a = 0; a < D; ++a) t[a] += c * r[b] * (own[b * D + a] + other[b * D + a]);
    }
    add_force_and_moment<D>(t, r, to);
  });
  SNOWSHED_UNROLL
  for (int d = 0; d < D; ++d) q[row * D + std::size_t(d)] = block[row * D * D] != 0 ? -sum[d] : 0.0;
  SNOWSHED_UNROLL
  for (int k = 0; k < turns; ++k) torque[row * turns + std::size_t(k)] = -0.25 * sum[D + k];
}

SNOWSHED_MODULE_VARIANT_END
