// The elastic trial and the stress of a particle, or of a pack of particles. A graphics card
// compiles this file, too.
#pragma once

#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/sym_tensor.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// b <- (I + G) b (I + G)^T with G = dt grad v (1.2.14), on a = b - I: with H = G b,
/// a <- a + H + H^T + H G^T.
template <class V, int D>
SNOWSHED_INLINE void update_left_cauchy_green(material::Sym<V, D>& a, const V (&gradient)[D][D]) {
  V h[D][D];
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      V sum = gradient[i][j];
      for (int k = 0; k < D; ++k) sum += gradient[i][k] * a(k, j);
      h[i][j] = sum;
    }
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      V sum = h[i][j] + h[j][i];
      for (int k = 0; k < D; ++k) sum += h[i][k] * gradient[j][k];
      a(i, j) += sum;
    }
}

template <class V, int D>
struct Stress {
  material::Sym<V, D> tau;  // Kirchhoff stress
  V strain_squared;         // |e|^2 of the Hencky strain at this stress
};

/// Returns the stress of the present elastic strain `a` = b - I.
///
/// return_map(pq) may bring pressure and Mises stress of the trial back to the yield surface, and
/// returns whether it may have changed them; the strain then follows.
template <class V, int D, class C, class ReturnMap>
SNOWSHED_INLINE Stress<V, D> stress_of(material::Sym<V, D>& a,
                                       const material::Elasticity<C>& elastic,
                                       const ReturnMap& return_map) {
  using T = Scalar<V>;
  material::Sym<V, D> e = material::hencky_strain(a);
  const V volumetric = material::trace(e);
  V third = volumetric * (T(1) / T(D));
  material::Sym<V, D> dev = e;
  for (int k = 0; k < D; ++k) dev.c[k] -= third;
  const V dev_squared = material::norm_squared(dev);
  V shear_ratio = broadcast<V>(T(1));
  const V p_trial = -elastic.bulk * volumetric;
  const V q_trial = sqrt(V(T(6) * dev_squared)) * elastic.mu;  // q = sqrt(3/2 s:s)
  material::PQ<V> pq{p_trial, q_trial};
  if (return_map(pq)) {
    const auto sheared = q_trial > T(0);
    shear_ratio = select(sheared, V(pq.q / select(sheared, q_trial, shear_ratio)), shear_ratio);
    third = pq.p * (T(-1) / (elastic.bulk * T(D)));
    for (int k = 0; k < e.size; ++k) e.c[k] = shear_ratio * dev.c[k];
    for (int k = 0; k < D; ++k) e.c[k] += third;
    const material::Sym<V, D> returned = material::cauchy_green_minus_identity(e);
    const auto changed = (pq.p != p_trial) | (pq.q != q_trial);
    for (int k = 0; k < e.size; ++k) a.c[k] = select(changed, returned.c[k], a.c[k]);
  }
  Stress<V, D> r;
  const V shear_scale = T(2) * elastic.mu * shear_ratio;
  for (int k = 0; k < e.size; ++k) r.tau.c[k] = shear_scale * dev.c[k];
  for (int k = 0; k < D; ++k) r.tau.c[k] -= pq.p;
  r.strain_squared = shear_ratio * shear_ratio * dev_squared + T(D) * third * third;
  return r;
}

SNOWSHED_MODULE_VARIANT_END
