// Interface between the MPS solver and its kernels: raw views, and a table of functions. The
// kernels are compiled once for each instruction set (cmake/KernelVariants.cmake), so nothing here
// depends on the instruction set. All take the rows [begin, end). A row is a particle, and its
// pairs are consecutive. The order in which a row is summed depends on the instruction set only.
#pragma once

#include <cstddef>
#include <cstdint>

#include "snowshed/particles/neighbour_search.hpp"

namespace snowshed::methods::mps {

/// The pairs of all particles, in compressed rows.
struct PairRows {
  const std::uint32_t *first, *index;  // first pair of each row; neighbour of each pair
};

/// The sums of a row from which corrections are computed: slope r r^T, weight r r^T (the upper
/// halves by rows) and weight r.
template <int D>
struct RowMoments {
  static constexpr int half = D * (D + 1) / 2;
  float slope[half], weight[half], side[D];
};

template <int D>
struct Kernels {
  particles::NeighbourSearch<D> search;
  /// Finds the weights r_e/r - 1, the weights over r^2 (`slope`), and the sums of the weights and
  /// of filling_weight of each row. `offset` has one array of separations per axis.
  void (*weigh)(const PairRows&, const float* const* offset, float reach, float* weight,
                float* slope, float* sum, float* filling, std::ptrdiff_t begin, std::ptrdiff_t end);
  void (*sum_moments)(const PairRows&, const float* const* offset, const float* weight,
                      const float* slope, RowMoments<D>*, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Multiplies the weight of each pair by e.B e, limited to 0.5 to 2. e is the direction of the
  /// separation, and B the mean of both particles' `correction` (upper halves by rows).
  void (*isotropic_weights)(const PairRows&, const float* const* offset, const float* weight,
                            const float* correction, float* corrected, std::ptrdiff_t begin,
                            std::ptrdiff_t end);
  /// q = diagonal p - sum of weight p; 0 in rows whose diagonal is zero.
  void (*apply)(const PairRows&, const float* weight, const double* diagonal, const double* p,
                double* q, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// The same in single precision: r = b - (diagonal x - sum of weight x).
  void (*residual)(const PairRows&, const float* weight, const float* diagonal, const float* x,
                   const float* b, float* r, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// q = block p - sum of coupling p, with vectors p and matrices by columns; 0 in rows whose block
  /// begins with zero.
  void (*apply_to_velocities)(const PairRows&, const float* coupling, const double* block,
                              const double* p, double* q, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// The sum of slope (u_j - u_i) r^T of each row, matrices by columns, 1/s.
  void (*sum_gradients)(const PairRows&, const float* const* offset, const float* slope,
                        const double* velocity, double* gradient, std::ptrdiff_t begin,
                        std::ptrdiff_t end);
  /// The sum of slope (value_j + base_i) r of each row; without values the sum of slope r.
  void (*sum_separations)(const PairRows&, const float* const* offset, const float* slope,
                          const double* value, const double* base, double* sum,
                          std::ptrdiff_t begin, std::ptrdiff_t end);
  /// The sum of e v over the neighbours nearer than `limit`, m/s. e is the direction to the
  /// neighbour; v is the speed of approach, not negative, times the neighbour's `share`.
  void (*sum_approaches)(const PairRows&, const float* const* offset, const double* velocity,
                         const double* share, double limit, double* sum, std::ptrdiff_t begin,
                         std::ptrdiff_t end);
  /// The shear rate (1/s) at the midpoint of each pair whose neighbour has the larger index. It
  /// follows from the mean of both gradients, in which the difference of the velocities replaces
  /// the part along the separation. The mean of `elastic` (1/s, null without one) is added.
  void (*pair_rates)(const PairRows&, const float* const* offset, const double* velocity,
                     const double* gradient, const double* elastic, float* rate,
                     std::ptrdiff_t begin, std::ptrdiff_t end);
  /// turn = sum of u_a l_b - u_b l_a in each row, the components a < b of a matrix; u is the change
  /// of p, and l the `lever` of the pair, a vector.
  void (*sum_turns)(const PairRows&, const float* lever, const double* p, double* turn,
                    std::ptrdiff_t begin, std::ptrdiff_t end);
  /// q = block p - sum of t in each row; q = 0 if the block begins with zero. t is twice the
  /// coupling times the change of p in a frame that turns with the mean of both particles' `turn`
  /// (antisymmetric components of a matrix). `torque` is -1/4 of the sum of t_a r_b - t_b r_a.
  void (*sum_stresses)(const PairRows&, const float* const* offset, const float* coupling,
                       const double* block, const double* p, const double* turn, double* q,
                       double* torque, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// Subtracts from q twice T_i l + sum of T_j m, in rows whose block does not begin with zero. T
  /// are the antisymmetric matrices of the torques, l is a row's `lever_sum`, and m the `far_lever`
  /// of a pair.
  void (*spread_torques)(const PairRows&, const float* far_lever, const double* lever_sum,
                         const double* block, const double* torque, double* q, std::ptrdiff_t begin,
                         std::ptrdiff_t end);
  /// q = - sum of t in each row, or 0 if the block begins with zero. t is the coupling times
  /// (tensor_i + tensor_j) r, with matrices by columns, and `torque` as in sum_stresses.
  void (*sum_tensors)(const PairRows&, const float* const* offset, const float* coupling,
                      const double* block, const double* tensor, double* q, double* torque,
                      std::ptrdiff_t begin, std::ptrdiff_t end);
};

/// The kernels of the instruction set in use.
template <int D>
const Kernels<D>& chosen_kernels();

}  // namespace snowshed::methods::mps
