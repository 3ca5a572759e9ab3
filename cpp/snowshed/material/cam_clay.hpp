// Cohesive Modified Cam-Clay snow (Gaume et al. 2018; thesis 1.2.5-1.2.7): the yield surface, its
// hardening law and the implicit associative return mapping, all in the p-q plane.
//
//   y(p, q) = (1 + 2 beta) q^2 + M^2 (p + beta p0)(p - p0) <= 0      (1.2.6)
//   p0 = K sinh(xi max(-e_v, 0)),  K = E/(3 - 6 nu)                   (1.2.7)
//
// p is positive in compression; e_v, the volumetric plastic strain, is negative in compaction.
//
// With a crack band (Bazant and Oh 1983), snow that has dilated beyond its initial plastic strain
// e_0 softens s times as fast: (1.2.7) holds with e_0 + s (e_v - e_0) in place of e_v > e_0. Cracks
// are a few cells wide on any grid; with s in proportion to the cells, the energy that a crack
// takes per area is the same on all. s = 1 is the law without it, bit for bit.
//
// With a relaxation time tau (Duvaut and Lions 1972) the stress may lie outside the yield surface.
// A step of dt leaves the share tau / (dt + tau) of this overstress (backward Euler); the plastic
// strain follows. Cracks and bands then have a width of their own, about tau times the speed of
// sound, where snow deforms faster than it relaxes. tau = 0 is the law without it, bit for bit.
#pragma once

#include "snowshed/core/simd_math.hpp"
#include "snowshed/material/elasticity.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(material)

/// Pressure and Mises stress in the Kirchhoff measure, Pa.
template <class V>
struct PQ {
  V p, q;
};

/// Constants and return mapping of a Cam-Clay material. With `regularised` it may have a crack band
/// and a relaxation time. C is a scalar if all particles of a pack share the constants, and a SIMD
/// pack if each particle has its own.
template <class C, bool regularised>
struct CamClayLaw {
  using T = Scalar<C>;
  Elasticity<C> elastic;
  C m2{};         ///< M^2, M the slope of the critical state line
  C beta{};       ///< cohesion: tensile strength over p0
  C xi{};         ///< hardening factor
  C hardening{};  ///< K, Pa
  // Only if regularised: the crack band.
  C softening = C{} + T(1);  ///< s
  C band_begin{};            ///< e_0

  static constexpr bool plastic = true;

  /// Returns the constants from E (Pa), nu, M, beta, xi. M is at least 1e-4. This is close to the
  /// frictionless limit, in which snow carries no shear but keeps its tensile strength and its
  /// preconsolidation pressure.
  static CamClayLaw from(double youngs_modulus, double poissons_ratio, double critical_state_slope,
                         double cohesion, double hardening_factor, int dimension) {
    const double slope = critical_state_slope > 1e-4 ? critical_state_slope : 1e-4;
    CamClayLaw c;
    c.elastic = Elasticity<C>::from(youngs_modulus, poissons_ratio, dimension);
    c.m2 = C(slope * slope);
    c.beta = C(cohesion);
    c.xi = C(hardening_factor);
    c.hardening = C(youngs_modulus / (3 - 6 * poissons_ratio));
    return c;
  }

  /// Returns the volumetric plastic strain at which p0 has the given value (inverse of 1.2.7).
  double initial_plastic_strain(double p0) const {
    return -std::asinh(p0 / double(hardening)) / double(xi);
  }

  /// Returns p0 of (1.2.7), Pa; `slope` receives d p0 / d e_v.
  template <class V>
  SNOWSHED_INLINE V preconsolidation(const V& ev, V& slope) const {
    const auto k = hyperbolic(max(V(-xi * softened(ev)), broadcast<V>(T(0))));
    slope = select(ev < end_of_strength(ev), strength_slope(k, ev), broadcast<V>(T(0)));
    return k.sinh;
  }
  template <class V>
  SNOWSHED_INLINE V preconsolidation(const V& ev) const {
    V slope;
    return preconsolidation(ev, slope);
  }

  /// Returns y of (1.2.6), Pa^2.
  template <class V>
  SNOWSHED_INLINE V yield(const PQ<V>& s, const V& p0) const {
    return (T(1) + T(2) * beta) * s.q * s.q + m2 * (s.p + beta * p0) * (s.p - p0);
  }

  /// Brings an elastic trial back to the yield surface by backward Euler with hardening; returns
  /// whether any particle of the pack yielded. The stress keeps the share `overstress` of its
  /// distance from the surface. This share is used only if regularised. With D the change of e_v,
  ///   p = p_tr + K_d D,   q = q_tr N / (N - c D),   y(p, q, p0(e_v + D)) = 0,
  /// where N = 2p - (1 - beta) p0 is y_p/M^2 and c = 6 mu (1 + 2 beta)/M^2. D is bracketed. At one
  /// end D = 0, the trial, and y > 0. At the other the flow becomes purely deviatoric (N = 0, y <
  /// 0), or the stress is zero if softening reduces p0 to zero before. Newton steps that leave the
  /// bracket are replaced by bisection.
  template <class V>
  SNOWSHED_INLINE bool return_map(PQ<V>& s, V& ev, T overstress = T(0)) const {
    // Snow that dilated far beyond the loss of its strength (u < -1) has no strength; u is clamped
    // there.
    const auto hardness = hyperbolic(max(V(-xi * softened(ev)), broadcast<V>(T(-1))));
    const auto yields = yield(s, strength(hardness)) > T(0);
    if (!any(yields)) return false;
    project(s, ev, hardness, yields, overstress);
    return true;
  }

 private:
  /// Returns the plastic strain that replaces e_v in (1.2.7).
  template <class V>
  SNOWSHED_INLINE V softened(const V& ev) const {
    if constexpr (regularised)
      return ev + (softening - T(1)) * max(V(ev - band_begin), broadcast<V>(T(0)));
    else
      return ev;
  }
  /// Returns the change of that strain when e_v changes by d.
  template <class V>
  SNOWSHED_INLINE V softened_by(const V& ev, const V& d) const {
    if constexpr (regularised) {
      const V zero = broadcast<V>(T(0));
      return d + (softening - T(1)) *
                     (max(V(ev + d - band_begin), zero) - max(V(ev - band_begin), zero));
    } else {
      return d;
    }
  }
  /// Returns the e_v from which on p0 is zero.
  template <class V>
  SNOWSHED_INLINE V end_of_strength(const V&) const {
    if constexpr (regularised)
      return broadcast<V>(C(band_begin - band_begin / softening));
    else
      return broadcast<V>(T(0));
  }

  /// K sinh(u) and K cosh(u), Pa.
  template <class V>
  struct Hyperbolic {
    V sinh, cosh;
  };
  template <class V>
  SNOWSHED_INLINE Hyperbolic<V> hyperbolic(const V& u) const {
    const V growth = expm1(u);  // exp(u) - 1
    const V ratio = growth / (growth + T(1));
    return {T(0.5) * hardening * (growth + ratio), T(0.5) * hardening * (growth - ratio + T(2))};
  }

  /// Returns the values at u + w from those at u, by the addition theorems with series in w. They
  /// are exact to rounding for |w| <= series_limit, at a fraction of the cost of an exponential.
  static constexpr T series_limit = T(0.01);
  template <class V>
  static SNOWSHED_INLINE Hyperbolic<V> shifted(const Hyperbolic<V>& k, const V& w) {
    const V w2 = w * w;
    const V sinh_w = w * (T(1) + w2 * (T(1) / T(6) + w2 * T(1) / T(120)));
    const V cosh_w = T(1) + w2 * (T(0.5) + w2 * (T(1) / T(24) + w2 * T(1) / T(720)));
    return {k.sinh * cosh_w + k.cosh * sinh_w, k.cosh * cosh_w + k.sinh * sinh_w};
  }

  /// Factor by which snow at e_v softens faster than in (1.2.7).
  template <class V>
  SNOWSHED_INLINE V softening_at(const V& ev) const {
    return select(ev > band_begin, broadcast<V>(softening), broadcast<V>(T(1)));
  }
  /// d p0 / d e_v where p0 > 0.
  template <class V>
  SNOWSHED_INLINE V strength_slope(const Hyperbolic<V>& k, const V& ev) const {
    if constexpr (regularised)
      return V(-xi * k.cosh) * softening_at(ev);
    else
      return V(-xi * k.cosh);
  }

  /// p0 from K sinh(u).
  template <class V>
  static SNOWSHED_INLINE V strength(const Hyperbolic<V>& k) {
    return max(k.sinh, broadcast<V>(T(0)));
  }

  /// The trial of a return, and how p0 changes from there.
  template <class V>
  struct Trial {
    PQ<V> s;
    V ev;
    Hyperbolic<V> hardness;  // at e_v
    bool series_suffices;    // for every possible change of e_v
  };

  /// Returns p0 once e_v has changed by d; `slope` receives d p0 / d e_v.
  template <class V>
  SNOWSHED_INLINE V preconsolidation_after(const Trial<V>& trial, const V& d, V& slope) const {
    if (!trial.series_suffices) return preconsolidation(V(trial.ev + d), slope);
    const auto k = shifted(trial.hardness, V(-xi * softened_by(trial.ev, d)));
    slope = select(k.sinh > T(0), strength_slope(k, V(trial.ev + d)), broadcast<V>(T(0)));
    return strength(k);
  }

  /// Replaces the trial by the returned state for the particles in `yields`.
  template <class V, class M>
  __attribute__((noinline)) void project(PQ<V>& s, V& ev, const Hyperbolic<V>& hardness,
                                         const M& yields, T overstress) const {
    const V zero = broadcast<V>(T(0));
    Trial<V> trial{s, ev, hardness, true};
    const V p0_old = strength(hardness);
    const V to_origin = -s.p / elastic.bulk;  // D at which p = 0
    // N of the trial: positive if the trial lies on the compressive side of the centre.
    const V n_trial = T(2) * s.p - (T(1) - beta) * p0_old;
    const auto compacts = n_trial > T(0);

    // The far end of the bracket. In compaction p = 0 lies past the centre. In dilation p0 reaches
    // zero at the end of strength, D = -e_v without a crack band (if e_v < 0).
    const V end = end_of_strength(ev);
    const V far = select(compacts, to_origin, max(V(end - ev), zero));
    // Loose snow has no strength left at the end: either p0 stays zero on the way to p = 0, or the
    // tension remains after softening to p0 = 0. Its stress becomes zero and e_v takes the rest of
    // the volume.
    const auto loose = ev + to_origin >= end;
    trial.series_suffices = !any(abs(V(xi * softened_by(ev, far))) > series_limit);

    const V d = root(trial, n_trial, far, yields & !loose);

    const V p = s.p + elastic.bulk * d;
    V slope;
    const V p0 = preconsolidation_after(trial, d, slope);
    const V p_on = clamp(p, V(-beta * p0), p0);
    // q lies exactly on the surface and never exceeds that of the trial.
    const V q_on =
        min(s.q, sqrt(max(V(m2 / (T(1) + T(2) * beta) * (p_on + beta * p0) * (p0 - p_on)), zero)));
    PQ<V> end_of_step{select(loose, zero, p_on), select(loose, zero, q_on)};
    if constexpr (regularised) {
      end_of_step.p += overstress * (s.p - end_of_step.p);
      end_of_step.q += overstress * (s.q - end_of_step.q);
    }
    // e_v takes exactly the volume that the elastic strain lost: p = p_tr + K_d D.
    ev = select(yields, V(ev + (end_of_step.p - s.p) / elastic.bulk), ev);
    s.p = select(yields, end_of_step.p, s.p);
    s.q = select(yields, end_of_step.q, s.q);
  }

  /// Returns the root D by safeguarded steps of Chebyshev's method, Newton's with a correction for
  /// the curvature of y; zero for particles that are not `sought`.
  template <class V, class M>
  SNOWSHED_INLINE V root(const Trial<V>& from, const V& n_trial, const V& far,
                         const M& sought) const {
    constexpr T tolerance = sizeof(T) == 4 ? T(3e-7) : T(1e-15);
    constexpr T root_of_tolerance = sizeof(T) == 4 ? T(5e-4) : T(3e-8);
    const V zero = broadcast<V>(T(0)), one = broadcast<V>(T(1));
    const C c = T(6) * elastic.mu * (T(1) + T(2) * beta) / m2;
    const PQ<V>& trial = from.s;
    const V p0_old = strength(from.hardness);
    // Close to the root, the search ends once the change of pressure is below rounding.
    const V pressure = abs(trial.p) + beta * p0_old;
    const V rounding = T(0.2) * tolerance * pressure;
    V near = zero, end = far;

    // First guess: N (q_tr/q_s - 1) + c D = 0. This is y = 0 written for the shear q_s on the
    // surface, with N linear in D. q_s is that at the pressure of the trial; if the trial lies
    // beyond the tips of the ellipse, it is that near the tips. The guess never passes the centre
    // line. It is zero, the trial itself, if q hardly decreases.
    const V inside =
        max(V((trial.p + beta * p0_old) * (p0_old - trial.p)), V(T(0.05) * p0_old * p0_old));
    const V q_s = sqrt(V(m2 / (T(1) + T(2) * beta) * inside));
    const V excess = clamp(V(trial.q / (q_s + T(1e-30)) - T(1)), zero, broadcast<V>(T(1e6)));
    V hardening_rate = broadcast<V>(xi);
    if constexpr (regularised) hardening_rate = hardening_rate * softening_at(from.ev);
    const V n_slope_trial =
        T(2) * elastic.bulk + (T(1) - beta) * hardening_rate * from.hardness.cosh;
    V d = -n_trial * excess / (c + n_slope_trial * excess);
    d = select(abs(d) < abs(far), d, V(T(0.5) * far));
    auto active = sought;
    for (int iteration = 0; iteration < 100; ++iteration) {
      V p0_slope;
      const V p0 = preconsolidation_after(from, d, p0_slope);
      const V p = trial.p + elastic.bulk * d;
      const V n = T(2) * p - (T(1) - beta) * p0;
      const V n_slope = T(2) * elastic.bulk - (T(1) - beta) * p0_slope;
      const V flow = n - c * d;  // has the sign of n: |flow| >= |n|
      const V per_flow = T(1) / select(abs(flow) > T(0), flow, one);
      const V q = trial.q * (n * per_flow);
      const V q_slope = trial.q * c * (n - d * n_slope) * per_flow * per_flow;
      const V shear = (T(1) + T(2) * beta) / m2 * q * q;
      const V y = shear + (p + beta * p0) * (p - p0);
      const auto before_center = n * n_trial > T(0);
      // The root is found where y is zero to rounding. The comparison fails where y overflows.
      const V size = shear + (abs(p) + beta * p0) * (abs(p) + p0);
      const auto solved = before_center & (abs(y) < tolerance * size);
      const V y_slope = T(2) * (T(1) + T(2) * beta) / m2 * q * q_slope +
                        (elastic.bulk + beta * p0_slope) * (p - p0) +
                        (p + beta * p0) * (elastic.bulk - p0_slope);
      // Past the root: inside the surface, or beyond the centre line.
      const auto past = (y <= T(0)) | (n * n_trial <= T(0));
      near = select(past, near, d);
      end = select(past, d, end);
      // Half the second derivative, without that of p0, which changes too little to matter.
      const V y_curve = (T(1) + T(2) * beta) / m2 *
                            (q_slope * q_slope - T(2) * q * q_slope * (n_slope - c) * per_flow) +
                        (elastic.bulk + beta * p0_slope) * (elastic.bulk - p0_slope);
      const V per_slope = T(1) / select(abs(y_slope) > T(0), y_slope, one);
      const V newton = y * per_slope;
      const V correction = clamp(V(newton * y_curve * per_slope), V(T(-0.5) * one), one);
      const V stepped = d - newton * (T(1) + correction);
      const V lo = min(near, end), hi = max(near, end);
      const auto usable = (stepped > lo) & (stepped < hi) & before_center;
      const V next = select(usable, stepped, V(T(0.5) * (near + end)));
      const V change = abs(V(next - d));
      const V change_of_p = change * (elastic.bulk - p0_slope);
      // After a small step the next one is smaller by the same factor again, hence below rounding.
      const auto small = (change <= root_of_tolerance * abs(next)) &
                         (change_of_p <= root_of_tolerance * pressure) & usable;
      const auto settled = ((change_of_p <= rounding) | small) & (abs(y) <= T(0.01) * size);
      const auto moved = (change > tolerance * abs(next)) & !settled;
      active = active & !solved;
      d = select(active, next, d);
      active = active & moved;
      if (!any(active)) break;
    }
    return select(sought, d, zero);
  }
};

template <class C>
using CamClay = CamClayLaw<C, false>;
template <class C>
using RegularisedCamClay = CamClayLaw<C, true>;

SNOWSHED_MODULE_VARIANT_END
