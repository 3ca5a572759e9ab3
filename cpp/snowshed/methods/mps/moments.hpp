// Symmetric matrices of which one half is stored.
#pragma once

#include <array>

#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"

namespace snowshed::methods::mps {

/// The matrix whose upper half is given by rows.
template <int D>
Eigen::Matrix<double, D, D> symmetric(const float* half) {
  Eigen::Matrix<double, D, D> m;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) m(a, b) = m(b, a) = double(*half++);
  return m;
}

/// The upper half of a symmetric matrix by rows.
template <int D>
std::array<float, RowMoments<D>::half> upper_half(const Eigen::Matrix<double, D, D>& m) {
  std::array<float, RowMoments<D>::half> half;
  std::size_t k = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) half[k++] = float(m(a, b));
  return half;
}

}  // namespace snowshed::methods::mps
