// Acceleration of fixed-point iterations.
#pragma once

#include <cmath>
#include <utility>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::methods::mps {

/// Anderson's acceleration of depth one (Anderson 1965, doi:10.1145/321296.321305; Walker and Ni
/// 2011, doi:10.1137/10078356X): the next point combines the last two results such that the
/// residual would be smallest if the iteration were linear.
template <int D>
class AndersonMixing {
 public:
  using Vectors = AlignedVector<VecD<D>>;

  /// Replaces `result`, which an iteration has made from `point`, by the next point.
  void mix(const Vectors& point, Vectors& result) {
    const std::size_t n = result.size();
    Vectors residual(n), plain = result;
    double square = 0, changed = 0, along = 0;
    for (std::size_t i = 0; i < n; ++i) {
      residual[i] = result[i] - point[i];
      square += residual[i].squaredNorm();
    }
    if (square < last_square_) {  // a diverging sequence is not extrapolated
      for (std::size_t i = 0; i < n; ++i) {
        const VecD<D> change = residual[i] - last_residual_[i];
        changed += change.squaredNorm();
        along += residual[i].dot(change);
      }
      const double share = changed > 0 ? along / changed : 0.0;
      if (std::abs(share) <= max_extrapolation)
        for (std::size_t i = 0; i < n; ++i) result[i] -= share * (result[i] - last_result_[i]);
    }
    last_square_ = square;
    last_residual_ = std::move(residual);
    last_result_ = std::move(plain);
  }

 private:
  static constexpr double max_extrapolation = 10;
  double last_square_ = 0;  // squared norm of the last residual; 0: there is none
  Vectors last_residual_, last_result_;
};

}  // namespace snowshed::methods::mps
