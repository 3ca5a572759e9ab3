// Sums over the pairs of a particle.
#pragma once

#include "snowshed/core/vec.hpp"

namespace snowshed {

/// The sum of factor r r^T, of which only one half is stored. Single precision suffices for a few
/// dozen pairs.
template <int D>
class MomentSum {
 public:
  void add(float factor, const float* r) {
    int k = 0;
    for (int a = 0; a < D; ++a) {
      const float scaled = factor * r[a];
      for (int b = a; b < D; ++b) sum_[k++] += scaled * r[b];
    }
  }
  Eigen::Matrix<double, D, D> matrix() const {
    Eigen::Matrix<double, D, D> m;
    int k = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) m(a, b) = m(b, a) = double(sum_[k++]);
    return m;
  }

 private:
  float sum_[D * (D + 1) / 2] = {};
};

}  // namespace snowshed
