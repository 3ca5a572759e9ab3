// The law of contact between two spheres: springs, a bond that breaks, Coulomb friction.
#pragma once

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/core/simd_vec.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::grains)

/// Motion of the second of two spheres in a step, relative to the first.
template <class V>
struct ContactMotion {
  V gap;              // m, between the surfaces, now; negative where they overlap
  V gap_growth;       // m, growth of the gap in this step
  SimdVec<V> normal;  // unit vector from the first to the second
  SimdVec<V> shear;   // m, displacement in this step normal to it
  V twist;            // rad, mean rotation of both about the normal in this step
};

/// Effect of a contact in a step.
template <class V, class Mask>
struct ContactForce {
  V normal_force;          // N, negative in tension
  SimdVec<V> shear_force;  // N, on the first sphere, normal to the normal
  V heat;                  // J, lost to friction
  V broken_energy;         // J, lost when the bond breaks
  Mask touching, tension_break, shear_break;
};

/// Linear springs along and across the normal. A bond bears tension up to a limit, and shear up to
/// a limit plus friction. Beyond these it breaks for good. Without a bond there is no tension, and
/// shear is at most friction (Cundall and Strack 1979 for the springs; Hagenmuller, Chambon and
/// Naaim 2015 for bonds between grains of snow. We have not seen the tables of the latter paper, so
/// two rules are inferred: friction raises the shear strength of a bond, and after a bond has
/// broken its pair has no cohesion).
struct BondLaw {
  double normal_stiffness = 0, shear_stiffness = 0;  // N/m
  double tension_limit = 0, shear_limit = 0;         // N
  double friction = 0;                               // Coulomb coefficient

  /// Updates the shear displacement `u` (m) and whether there is a bond. The displacement turns
  /// with the contact. The lost energy is the work of the mean of the forces before and after the
  /// step, minus the energy that the springs store. The energy balance therefore closes with a
  /// trapezoidal integration of the motion.
  template <class V, class Mask>
  SNOWSHED_INLINE ContactForce<V, Mask> operator()(const ContactMotion<V>& m, SimdVec<V>& u,
                                                   Mask& bonded) const {
    const V zero{}, kn = broadcast<V>(normal_stiffness), ks = broadcast<V>(shear_stiffness);
    const SimdVec<V> before = turned(m, u);
    const SimdVec<V> trial = before + m.shear;
    const V length = sqrt(dot(trial, trial));
    const V spring = -kn * m.gap, cap = friction * max(spring, zero);

    ContactForce<V, Mask> f;
    f.tension_break = bonded & (V(-spring) > tension_limit);
    f.shear_break = bonded & (V(ks * length) > V(shear_limit + cap)) & (f.tension_break == 0);
    const Mask breaks = f.tension_break | f.shear_break;
    const Mask holds = bonded & (breaks == 0);
    f.touching = holds | (m.gap < zero);
    f.normal_force = select(f.touching, spring, zero);

    const Mask slips = (holds == 0) & (V(ks * length) > cap);
    const V tiny_force = broadcast<V>(1e-300);
    const V share = select(slips, V(cap / max(V(ks * length), tiny_force)), broadcast<V>(1.0));
    u = V(select(f.touching, share, zero)) * trial;
    f.shear_force = ks * u;

    const V slip_work = V(0.5 * ks) * dot(before + u, trial - u);
    const V gap_before = m.gap - m.gap_growth;
    const V work = 0.5 * (kn * gap_before - f.normal_force) * m.gap_growth;
    const V stored = 0.5 * kn * (gap_before * gap_before) -
                     select(f.touching, V(0.5 * kn * (m.gap * m.gap)), zero);
    f.heat = select(breaks, zero, slip_work);
    f.broken_energy = select(breaks, V(slip_work + work + stored), zero);
    bonded = holds;
    return f;
  }

 private:
  /// A displacement turned into the present plane of the contact, of the same length.
  template <class V>
  static SNOWSHED_INLINE SimdVec<V> turned(const ContactMotion<V>& m, const SimdVec<V>& u) {
    const SimdVec<V> twisted = u + m.twist * cross(m.normal, u);
    const SimdVec<V> flat = twisted - dot(m.normal, twisted) * m.normal;
    const V square = dot(flat, flat);
    return V(sqrt(V(dot(u, u) / max(square, broadcast<V>(1e-300))))) * flat;
  }
};

SNOWSHED_MODULE_VARIANT_END
