// Sums of many numbers that are right to the last digits.
#pragma once

#include <cmath>
#include <cstddef>

namespace snowshed {

/// The sum of n numbers, whose rounding errors are summed separately (Neumaier 1974,
/// doi:10.1002/zamm.19740540106): the error does not grow with n.
inline double compensated_sum(const double* values, std::size_t n) {
  double sum = 0, correction = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double value = values[i], next = sum + value;
    correction += std::abs(sum) >= std::abs(value) ? (sum - next) + value : (value - next) + sum;
    sum = next;
  }
  return sum + correction;
}

}  // namespace snowshed
