// Symmetric matrices of which one half is stored.
#pragma once

#include "snowshed/core/vec.hpp"

namespace snowshed {

/// The matrix whose upper half is given by rows.
template <int D>
Eigen::Matrix<double, D, D> symmetric(const float* half) {
  Eigen::Matrix<double, D, D> m;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) m(a, b) = m(b, a) = double(*half++);
  return m;
}

}  // namespace snowshed
