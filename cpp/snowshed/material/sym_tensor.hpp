// Symmetric tensors in D dimensions with their logarithm and exponential, the two functions that
// Hencky elasticity needs. Both are taken relative to the identity, so that single precision keeps
// small strains.
#pragma once

#include "snowshed/core/simd_math.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(material)

/// A symmetric tensor. Its components are xx, zz, xz (D = 2) or xx, yy, zz, xy, xz, yz (D = 3).
template <class V, int D>
struct Sym {
  static constexpr int size = D * (D + 1) / 2;
  V c[size];

  static constexpr int index(int i, int j) {
    if (i == j) return i;
    return D == 2 ? 2 : (i + j) + 2;  // (0,1) -> 3, (0,2) -> 4, (1,2) -> 5
  }
  SNOWSHED_INLINE const V& operator()(int i, int j) const { return c[index(i, j)]; }
  SNOWSHED_INLINE V& operator()(int i, int j) { return c[index(i, j)]; }
};

template <class V, int D>
SNOWSHED_INLINE V trace(const Sym<V, D>& a) {
  V t = a.c[0] + a.c[1];
  if constexpr (D == 3) t += a.c[2];
  return t;
}

/// Returns a : a.
template <class V, int D>
SNOWSHED_INLINE V norm_squared(const Sym<V, D>& a) {
  V diagonal = a.c[0] * a.c[0] + a.c[1] * a.c[1];
  V off = a.c[D] * a.c[D];
  if constexpr (D == 3) {
    diagonal += a.c[2] * a.c[2];
    off += a.c[4] * a.c[4] + a.c[5] * a.c[5];
  }
  return diagonal + (off + off);
}

template <class V, int D>
SNOWSHED_INLINE Sym<V, D> square(const Sym<V, D>& a) {
  Sym<V, D> r;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      V s = a(i, 0) * a(0, j) + a(i, 1) * a(1, j);
      if constexpr (D == 3) s += a(i, 2) * a(2, j);
      r(i, j) = s;
    }
  return r;
}

template <class V, int D>
SNOWSHED_INLINE V determinant(const Sym<V, D>& a) {
  if constexpr (D == 2) {
    return a.c[0] * a.c[1] - a.c[2] * a.c[2];
  } else {
    return a.c[0] * (a.c[1] * a.c[2] - a.c[5] * a.c[5]) -
           a.c[3] * (a.c[3] * a.c[2] - a.c[5] * a.c[4]) +
           a.c[4] * (a.c[3] * a.c[5] - a.c[1] * a.c[4]);
  }
}

namespace detail {

/// Below this norm the power series is used instead of an eigen-decomposition. The strains of snow
/// practically always are this small: p0/E bounds the elastic ones, and an impact adds some percent
/// in a step.
inline constexpr double series_norm = 0.1;

/// Returns the sum over n >= 1 of coefficient(n) A^n by the Cayley-Hamilton recurrence
/// A^n = x A^2 + y A + z I. It needs one matrix product in all.
template <int Terms, class V, int D, class Coefficient>
SNOWSHED_INLINE Sym<V, D> power_series(const Sym<V, D>& a, Coefficient coefficient) {
  using T = Scalar<V>;
  const V i1 = trace(a);
  const V zero = broadcast<V>(T(0));
  const V one = broadcast<V>(T(1));
  Sym<V, D> r;
  if constexpr (D == 2) {
    const V i2 = determinant(a);
    V y = one, z = zero, cy = coefficient(1) * one, cz = zero;
    for (int n = 2; n <= Terms; ++n) {
      const V next_y = y * i1 + z;
      z = -y * i2;
      y = next_y;
      cy += coefficient(n) * y;
      cz += coefficient(n) * z;
    }
    for (int k = 0; k < 3; ++k) r.c[k] = cy * a.c[k];
    for (int k = 0; k < 2; ++k) r.c[k] += cz;
  } else {
    const Sym<V, D> a2 = square(a);
    const V i2 = (i1 * i1 - trace(a2)) * T(0.5);
    const V i3 = determinant(a);
    V x = zero, y = one, z = zero;
    V cx = zero, cy = coefficient(1) * one, cz = zero;
    for (int n = 2; n <= Terms; ++n) {
      const V next_x = x * i1 + y;
      const V next_y = z - x * i2;
      z = x * i3;
      x = next_x;
      y = next_y;
      cx += coefficient(n) * x;
      cy += coefficient(n) * y;
      cz += coefficient(n) * z;
    }
    for (int k = 0; k < 6; ++k) r.c[k] = cx * a2.c[k] + cy * a.c[k];
    for (int k = 0; k < 3; ++k) r.c[k] += cz;
  }
  return r;
}

/// Applies the Jacobi rotation that zeroes a(P, Q) to `a` and to the eigenvectors, the columns of
/// q.
template <int P, int Q, class V, int D>
SNOWSHED_INLINE void jacobi_rotate(Sym<V, D>& a, V (&q)[D][D]) {
  using T = Scalar<V>;
  const V apq = a(P, Q);
  const V h = a(Q, Q) - a(P, P);
  const V root = sqrt(V(h * h + T(4) * apq * apq));
  const V t = select(h < T(0), V(T(-2) * apq), V(T(2) * apq)) / (abs(h) + root + T(1e-30));
  const V c = T(1) / sqrt(V(t * t + T(1)));
  const V s = t * c;
  a(P, P) -= t * apq;
  a(Q, Q) += t * apq;
  a(P, Q) = broadcast<V>(T(0));
  if constexpr (D == 3) {
    constexpr int R = 3 - P - Q;
    const V arp = a(R, P), arq = a(R, Q);
    a(R, P) = c * arp - s * arq;
    a(R, Q) = s * arp + c * arq;
  }
  for (int i = 0; i < D; ++i) {
    const V qp = q[i][P], qq = q[i][Q];
    q[i][P] = c * qp - s * qq;
    q[i][Q] = s * qp + c * qq;
  }
}

/// Returns the tensor function f(a) by applying f to the eigenvalues of a, found by cyclic Jacobi
/// rotations. These converge quadratically; six sweeps reach round-off for any symmetric 3 x 3
/// tensor in double precision.
template <class V, int D, class F>
__attribute__((noinline)) Sym<V, D> spectral(Sym<V, D> a, F f) {
  using T = Scalar<V>;
  V q[D][D];
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) q[i][j] = broadcast<V>(T(i == j));
  if constexpr (D == 2) {
    jacobi_rotate<0, 1>(a, q);
  } else {
    for (int sweep = 0; sweep < 6; ++sweep) {
      jacobi_rotate<0, 1>(a, q);
      jacobi_rotate<0, 2>(a, q);
      jacobi_rotate<1, 2>(a, q);
    }
  }
  V w[D];
  for (int k = 0; k < D; ++k) w[k] = f(a.c[k]);
  Sym<V, D> r;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      V s = w[0] * q[i][0] * q[j][0] + w[1] * q[i][1] * q[j][1];
      if constexpr (D == 3) s += w[2] * q[i][2] * q[j][2];
      r(i, j) = s;
    }
  return r;
}

}  // namespace detail

/// Returns the Hencky strain (1/2) log(b) of the left Cauchy-Green tensor b = I + a (thesis
/// 1.1.29).
template <class V, int D>
SNOWSHED_INLINE Sym<V, D> hencky_strain(const Sym<V, D>& a) {
  using T = Scalar<V>;
  constexpr int terms = sizeof(T) == 4 ? 7 : 15;  // norm^terms / (terms + 1) is below rounding
  if (!any(norm_squared(a) > T(detail::series_norm * detail::series_norm)))
    return detail::power_series<terms>(a, [](int n) { return T(n % 2 ? 0.5 : -0.5) / T(n); });
  return detail::spectral(a, [](const V& x) { return V(T(0.5) * log1p(x)); });
}

/// Returns b - I = exp(2 e) - I for the Hencky strain e.
template <class V, int D>
SNOWSHED_INLINE Sym<V, D> cauchy_green_minus_identity(const Sym<V, D>& e) {
  using T = Scalar<V>;
  constexpr int terms = sizeof(T) == 4 ? 5 : 10;
  constexpr double limit = detail::series_norm / 2;
  if (!any(norm_squared(e) > T(limit * limit))) {
    static constexpr T c[] = {T(1),         T(2),          T(2),          T(4.0 / 3),
                              T(2.0 / 3),   T(4.0 / 15),   T(4.0 / 45),   T(8.0 / 315),
                              T(2.0 / 315), T(4.0 / 2835), T(4.0 / 14175)};
    return detail::power_series<terms>(e, [](int n) { return c[n]; });  // 2^n/n!
  }
  return detail::spectral(e, [](const V& x) { return expm1(V(x + x)); });
}

SNOWSHED_MODULE_VARIANT_END
