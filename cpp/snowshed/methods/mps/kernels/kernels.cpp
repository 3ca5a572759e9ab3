// The kernels of MPS for one instruction set.
#include "snowshed/methods/mps/kernels/products.hpp"
#include "snowshed/methods/mps/kernels/rates.hpp"
#include "snowshed/methods/mps/kernels/search.hpp"
#include "snowshed/methods/mps/kernels/stress.hpp"
#include "snowshed/methods/mps/kernels/weights.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mps)
namespace {

template <int D>
struct Rows {
  static std::size_t search(const particles::SearchedPoints<D>& points, std::uint32_t i,
                            std::uint32_t begin, std::uint32_t end, std::uint32_t* neighbours) {
    return find_near<D>(points, i, begin, end, neighbours);
  }
  static void weigh(const PairRows& rows, const float* const* offset, float reach, float* weight,
                    float* slope, float* sum, float* filling, std::ptrdiff_t begin,
                    std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      weigh_row<D>(rows, offset, reach, weight, slope, sum[i], filling[i], std::size_t(i));
  }
  static void sum_moments(const PairRows& rows, const float* const* offset, const float* weight,
                          const float* slope, RowMoments<D>* moments, std::ptrdiff_t begin,
                          std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_moments<D>(rows, offset, weight, slope, moments[i], std::size_t(i));
  }
  static void isotropic_weights(const PairRows& rows, const float* const* offset,
                                const float* weight, const float* correction, float* corrected,
                                std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      find_isotropic_weights<D>(rows, offset, weight, correction, corrected, std::size_t(i));
  }
  static void apply(const PairRows& rows, const float* weight, const double* diagonal,
                    const double* p, double* q, std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      q[i] = diagonal[i] > 0 ? diagonal[i] * p[i] - sum_row(rows, weight, p, std::size_t(i)) : 0.0;
  }
  static void residual(const PairRows& rows, const float* weight, const float* diagonal,
                       const float* x, const float* b, float* r, std::ptrdiff_t begin,
                       std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      r[i] = diagonal[i] > 0 ? b[i] - diagonal[i] * x[i] + sum_row(rows, weight, x, std::size_t(i))
                             : 0.0f;
  }
  static void apply_to_velocities(const PairRows& rows, const float* coupling, const double* block,
                                  const double* p, double* q, std::ptrdiff_t begin,
                                  std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      apply_row_to_velocities<D>(rows, coupling, block, p, q, std::size_t(i));
  }
  static void sum_gradients(const PairRows& rows, const float* const* offset, const float* slope,
                            const double* velocity, double* gradient, std::ptrdiff_t begin,
                            std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_gradients<D>(rows, offset, slope, velocity, gradient, std::size_t(i));
  }
  static void sum_separations(const PairRows& rows, const float* const* offset, const float* slope,
                              const double* value, const double* base, double* sum,
                              std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      if (value)
        sum_row_separations<D, true>(rows, offset, slope, value, base[i], sum, std::size_t(i));
      else
        sum_row_separations<D, false>(rows, offset, slope, value, 0.0, sum, std::size_t(i));
  }
  static void sum_approaches(const PairRows& rows, const float* const* offset,
                             const double* velocity, const double* share, double limit, double* sum,
                             std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_approaches<D>(rows, offset, velocity, share, limit, sum, std::size_t(i));
  }
  static void pair_rates(const PairRows& rows, const float* const* offset, const double* velocity,
                         const double* gradient, const double* elastic, float* rate,
                         std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      find_pair_rates<D>(rows, offset, velocity, gradient, elastic, rate, std::size_t(i));
  }
  static void sum_stresses(const PairRows& rows, const float* const* offset, const float* coupling,
                           const double* block, const double* p, const double* turn, double* q,
                           double* torque, std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_stresses<D>(rows, offset, coupling, block, p, turn, q, torque, std::size_t(i));
  }
  static void sum_turns(const PairRows& rows, const float* lever, const double* p, double* turn,
                        std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_turns<D>(rows, lever, p, turn, std::size_t(i));
  }
  static void spread_torques(const PairRows& rows, const float* far_lever, const double* lever_sum,
                             const double* block, const double* torque, double* q,
                             std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      spread_row_torques<D>(rows, far_lever, lever_sum, block, torque, q, std::size_t(i));
  }
  static void sum_tensors(const PairRows& rows, const float* const* offset, const float* coupling,
                          const double* block, const double* tensor, double* q, double* torque,
                          std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum_row_tensors<D>(rows, offset, coupling, block, tensor, q, torque, std::size_t(i));
  }

  static constexpr Kernels<D> table{
      &search,          &weigh,          &sum_moments,         &isotropic_weights,
      &apply,           &residual,       &apply_to_velocities, &sum_gradients,
      &sum_separations, &sum_approaches, &pair_rates,          &sum_turns,
      &sum_stresses,    &spread_torques, &sum_tensors};
};

}  // namespace

extern const Kernels<2> kernel_table_2d;
extern const Kernels<3> kernel_table_3d;
const Kernels<2> kernel_table_2d = Rows<2>::table;
const Kernels<3> kernel_table_3d = Rows<3>::table;

SNOWSHED_MODULE_VARIANT_END
