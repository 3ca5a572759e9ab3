// Quadratic and cubic B-spline weights (thesis 1.2.17-1.2.22).
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/methods/mpm/basis.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Weights and derivatives (per cell) at the nodes a particle touches along one direction; f in
/// [0, 1) is the particle's fraction past its lowest node plus base_offset.
template <Basis basis>
struct BSpline;

template <>
struct BSpline<Basis::quadratic> {
  static constexpr int support = 3;
  template <class V>
  static SNOWSHED_INLINE void evaluate(const V& f, V (&w)[3], V (&g)[3]) {
    using T = Scalar<V>;
    const V r = T(1) - f, h = f - T(0.5);
    w[0] = T(0.5) * r * r;
    w[1] = T(0.75) - h * h;
    w[2] = T(0.5) * f * f;
    g[0] = -r;
    g[1] = T(-2) * h;
    g[2] = f;
  }
};

template <>
struct BSpline<Basis::cubic> {
  static constexpr int support = 4;
  template <class V>
  static SNOWSHED_INLINE void evaluate(const V& f, V (&w)[4], V (&g)[4]) {
    using T = Scalar<V>;
    const V r = T(1) - f, f2 = f * f, r2 = r * r;
    w[0] = T(1.0 / 6) * r2 * r;
    w[1] = T(2.0 / 3) - f2 + T(0.5) * f2 * f;
    w[2] = T(2.0 / 3) - r2 + T(0.5) * r2 * r;
    w[3] = T(1.0 / 6) * f2 * f;
    g[0] = T(-0.5) * r2;
    g[1] = f * (T(1.5) * f - T(2));
    g[2] = -r * (T(1.5) * r - T(2));
    g[3] = T(0.5) * f2;
  }
};

/// Finds the weights r of the steps between the values of consecutive nodes, given the weights w of
/// the values, by summation by parts: sum_k w_k n_k = (sum_k w_k) n_1 + sum_k r_k (n_{k+1} - n_k).
template <class V, int S>
SNOWSHED_INLINE void weights_of_steps(const V (&w)[S], V (&r)[S - 1]) {
  r[0] = -w[0];
  r[S - 2] = w[S - 1];
  SNOWSHED_UNROLL
  for (int k = S - 3; k > 0; --k) r[k] = r[k + 1] + w[k + 1];
}

SNOWSHED_MODULE_VARIANT_END
