// The forces between the spheres of two bodies, four pairs at a time.
#pragma once

#include "snowshed/core/simd_quad.hpp"
#include "snowshed/methods/grains/bond_law.hpp"
#include "snowshed/methods/grains/kernel_api.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::grains)

using QuadVec = SimdVec<Quad>;

SNOWSHED_INLINE QuadVec broadcast_vec(const double* v) {
  return {broadcast<Quad>(v[0]), broadcast<Quad>(v[1]), broadcast<Quad>(v[2])};
}
SNOWSHED_INLINE QuadVec load_vec(const double* x, const double* y, const double* z,
                                 std::size_t at) {
  return {load_row(x + at), load_row(y + at), load_row(z + at)};
}
/// Turns the offset of a point from its body's centre out of the body's frame into space.
SNOWSHED_INLINE QuadVec rotated(const double* r, const QuadVec& p) {
  return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
          r[6] * p.x + r[7] * p.y + r[8] * p.z};
}
SNOWSHED_INLINE double sum_of(const Quad& v) { return (v[0] + v[1]) + (v[2] + v[3]); }
SNOWSHED_INLINE void store_sums(double* to, const QuadVec& v) {
  to[0] = sum_of(v.x);
  to[1] = sum_of(v.y);
  to[2] = sum_of(v.z);
}
SNOWSHED_INLINE std::int32_t count_of(const QuadMask& mask) {
  return -std::int32_t((mask[0] + mask[1]) + (mask[2] + mask[3]));
}

SNOWSHED_INLINE QuadMask load_mask(const std::uint8_t* flags) {
  QuadMask mask;
  for (int i = 0; i < 4; ++i) mask[i] = -std::int64_t(flags[i]);
  return mask;
}
SNOWSHED_INLINE void store_mask(std::uint8_t* flags, const QuadMask& mask) {
  for (int i = 0; i < 4; ++i) flags[i] = std::uint8_t(mask[i] & 1);
}

/// Motion of the second of two bodies relative to the first.
struct PairedBodies {
  const BodyFrame &a, &b;
  // Offset (m) and velocity (m/s) of the second centre, at its periodic image, from the first.
  double center_offset[3], relative_velocity[3];

  SNOWSHED_INLINE PairedBodies(const View& s, const PairGroup& g)
      : a(s.bodies[g.first]), b(s.bodies[g.second]) {
    for (int i = 0; i < 3; ++i) {
      center_offset[i] = b.position[i] - a.position[i];
      relative_velocity[i] = b.velocity[i] - a.velocity[i];
    }
    for (int i = 0; i < 2; ++i) {
      center_offset[i] += g.shift[i] * s.period[i];
      relative_velocity[i] += g.shift[i] * s.period_growth[i];
    }
  }
};

SNOWSHED_INLINE void group_forces(const View& s, std::size_t group) {
  const PairGroup& g = s.groups[group];
  const PairedBodies pair(s, g);
  const BondLaw law{s.normal_stiffness, s.shear_stiffness, s.tension_limit, s.shear_limit,
                    s.friction};
  const QuadVec center_offset = broadcast_vec(pair.center_offset),
                relative_velocity = broadcast_vec(pair.relative_velocity);
  const QuadVec spin_a = broadcast_vec(pair.a.spin), spin_b = broadcast_vec(pair.b.spin);
  const Quad dt = broadcast<Quad>(s.time_step);
  QuadVec force{}, torque_a{}, torque_b{};
  Quad heat{}, broken{};
  QuadMask touching{}, tension{}, shear{};
  for (std::size_t p = g.begin; p < g.end; p += pairs_at_once) {
    const QuadVec from_a = rotated(pair.a.rotation, load_vec(s.ax, s.ay, s.az, p));
    const QuadVec from_b = rotated(pair.b.rotation, load_vec(s.bx, s.by, s.bz, p));
    const QuadVec offset = center_offset + from_b - from_a;
    const Quad square = dot(offset, offset);
    QuadMask bonded = load_mask(s.bonded + p);
    const QuadMask near = square < s.diameter * s.diameter;
    QuadVec u = load_vec(s.ux, s.uy, s.uz, p);
    const QuadMask sheared = dot(u, u) > 0.0;
    if (!any(QuadMask(near | bonded | sheared))) continue;

    const Quad distance = sqrt(max(square, broadcast<Quad>(1e-60)));
    const QuadVec normal = Quad(1.0 / distance) * offset;
    const QuadVec arm_a = from_a + Quad(0.5 * distance) * normal;
    const QuadVec arm_b = arm_a - center_offset;
    const QuadVec velocity = relative_velocity + cross(spin_b, arm_b) - cross(spin_a, arm_a);
    const Quad along = dot(velocity, normal);
    const ContactMotion<Quad> motion{Quad(distance - s.diameter), Quad(dt * along), normal,
                                     dt * (velocity - along * normal),
                                     Quad(0.5 * dt * dot(normal, spin_a + spin_b))};
    const ContactForce<Quad, QuadMask> f = law(motion, u, bonded);

    const QuadVec on_a = f.shear_force - f.normal_force * normal;
    force = force + on_a;
    torque_a = torque_a + cross(arm_a, on_a);
    torque_b = torque_b - cross(arm_b, on_a);
    heat += f.heat;
    broken += f.broken_energy;
    touching += f.touching;
    tension += f.tension_break;
    shear += f.shear_break;
    store_row(s.ux + p, u.x);
    store_row(s.uy + p, u.y);
    store_row(s.uz + p, u.z);
    store_mask(s.bonded + p, bonded);
  }
  GroupForce& r = s.results[group];
  store_sums(r.force, force);
  store_sums(r.torque_on_first, torque_a);
  store_sums(r.torque_on_second, torque_b);
  r.heat = sum_of(heat);
  r.broken_energy = sum_of(broken);
  r.touching = count_of(touching);
  r.tension_breaks = count_of(tension);
  r.shear_breaks = count_of(shear);
}

SNOWSHED_MODULE_VARIANT_END
