// The end of a step: velocities after all forces, and new positions of the particles on the ground.
#pragma once

#include "snowshed/methods/slide/kernels/bond_forces.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

inline constexpr double min_slide_speed = 1e-6;  // m/s
// m/s; above sqrt(min_square), which `length_from` returns for zero.
inline constexpr double max_rest_speed = 2e-15;

/// A velocity after friction, and the time for which the particle moves, s.
struct PackFrictionResult {
  PackVec velocity;
  Pack moving;
};

/// Coulomb friction as a set-valued law: it stops snow, and holds it while the driving force is
/// smaller than friction. Drag, quadratic in the speed, is implicit: s' + drag dt s'^2 = s.
/// `coulomb_deceleration` is in m/s2, `drag` in 1/m.
SNOWSHED_INLINE PackFrictionResult after_set_valued_friction(const View& s, const PackVec& u,
                                                             const Pack& coulomb_deceleration,
                                                             const Pack& drag) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack square = max(dot(u, u), broadcast<Pack>(min_square));
  const Pack per_speed = inverse_sqrt(square);
  const Pack remaining_speed = max(Pack{}, Pack(square * per_speed - dt * coulomb_deceleration));
  const Pack after =
      2.0 * remaining_speed / (1.0 + length_from(Pack(1.0 + 4.0 * drag * dt * remaining_speed)));
  return {Pack(after * per_speed) * u, dt};
}

/// AvaFrame's default: implicit friction with the rate deceleration / previous speed.
/// `deceleration` is in m/s2.
SNOWSHED_INLINE PackFrictionResult after_implicit_friction(const View& s, const PackVec& u,
                                                           const Pack& deceleration,
                                                           const Pack& speed) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack rate = deceleration / max(speed, broadcast<Pack>(min_slide_speed));
  return {Pack(1.0 / (1.0 + dt * rate)) * u, dt};
}

/// Explicit friction: `deceleration` (m/s2) acts until the particle rests. `before` is the speed at
/// the beginning of the step, m/s.
SNOWSHED_INLINE PackFrictionResult after_explicit_friction(const View& s, const PackVec& u,
                                                           const Pack& deceleration,
                                                           const Pack& before) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack square = max(dot(u, u), broadcast<Pack>(min_square));
  const Pack per_speed = inverse_sqrt(square), speed = square * per_speed;
  const PackMask moves = speed >= dt * deceleration;
  const Pack left = select(moves, Pack(1.0 - dt * deceleration * per_speed), Pack{});
  const Pack until_rest = speed / max(deceleration, broadcast<Pack>(min_square));
  return {left * u, select(moves, dt, select(before > max_rest_speed, until_rest, Pack{}))};
}

SNOWSHED_INLINE PackFrictionResult after_friction(const View& s, const Lanes& l, const PackVec& u) {
  const Pack coulomb_deceleration = l.load(s.coulomb_deceleration), drag = l.load(s.drag),
             speed = l.load(s.speed);
  if (s.scheme == FrictionScheme::set_valued)
    return after_set_valued_friction(s, u, coulomb_deceleration, drag);
  const Pack deceleration = coulomb_deceleration + drag * speed * speed;
  return s.scheme == FrictionScheme::avaframe_implicit
             ? after_implicit_friction(s, u, deceleration, speed)
             : after_explicit_friction(s, u, deceleration, speed);
}

/// The velocity, projected onto the ground and scaled back to its speed.
SNOWSHED_INLINE PackVec along_ground(const PackVec& u, const PackVec& normal, double added_speed) {
  const PackVec tangential = u - dot(u, normal) * normal;
  const Pack speed = length_from(dot(tangential, tangential));
  return Pack(length_from(dot(u, u)) / (speed + added_speed)) * tangential;
}

/// A velocity after all forces, and the position that it reaches.
struct PackMotion {
  PackVec velocity;
  PackVec to;
  PackMask moves;  // resting snow stays where it is, to the last bit
  PackReprojection on_ground;
};

/// The acceleration by all loads except friction, which acts later.
SNOWSHED_INLINE PackVec acceleration(const View& s, const Lanes& l) {
  const PackRecord force = transposed_to_packs([&](int k) SNOWSHED_INLINE_LAMBDA {
    const std::ptrdiff_t i = l.first + (k < l.count ? k : 0);
    return Quad(load_row(s.pressure_force + 4 * i) + bond_force_on(s, i));
  });
  const PackVec a =
      l.load(s.ax, s.ay, s.az) + Pack(1.0 / l.load(s.mass)) * PackVec{force.a, force.b, force.c};
  l.store(s.ax, s.ay, s.az, a);
  return a;
}

/// Computes the velocities (m/s) after all forces, and the positions (m) that they reach before
/// reprojection.
SNOWSHED_INLINE void accelerate(const View& s, const Lanes& l, PackMotion& motion) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const PackVec before = l.load(s.ux, s.uy, s.uz);
  const PackFrictionResult result = after_friction(s, l, before + dt * acceleration(s, l));
  const PackVec velocity_sum = before + result.velocity;
  motion.velocity = result.velocity;
  motion.moves = dot(velocity_sum, velocity_sum) > 0.0;
  motion.to = l.load(s.x, s.y, s.z) + Pack(0.5 * result.moving) * velocity_sum;
}

/// Stores the new positions of particles; returns their kinetic energy, J.
SNOWSHED_INLINE Pack store_new_positions(const View& s, const Lanes& l, const PackMotion& motion) {
  const PackReprojection& r = motion.on_ground;
  const PackGround ground = ground_at(s, r.on_ground);
  const PackMask stays = r.on_ground.inside & ground.known;
  const PackVec u = along_ground(motion.velocity, ground.normal, s.added_speed);
  l.store(s.x, s.y, s.z, {r.x, r.y, select(motion.moves, ground.height, motion.to.z)});
  l.store(s.ux, s.uy, s.uz, u);
  store_position(s, l, r.on_ground, ground.normal);
  l.store_flags(s.removed, ~stays);
  const Pack kinetic = 0.5 * l.load(s.mass) * dot(motion.velocity, motion.velocity);
  return select(PackMask(stays & l.filled()), kinetic, Pack{});
}

/// Moves the particles of a batch; returns their kinetic energy, J.
SNOWSHED_INLINE double move_batch(const View& s, std::ptrdiff_t begin, std::ptrdiff_t end,
                                  int packs) {
  PackMotion motion[packs_in_batch];
  for (int k = 0; k < packs; ++k) accelerate(s, lanes_of(begin, end, k), motion[k]);
  for (int k = 0; k < packs; ++k) {
    const PackVec& to = motion[k].to;
    motion[k].on_ground = reproject(s, to.x, to.y, to.z, motion[k].moves);
  }
  Pack kinetic{};
  for (int k = 0; k < packs; ++k)
    kinetic += store_new_positions(s, lanes_of(begin, end, k), motion[k]);
  return sum_of_lanes(kinetic);
}

SNOWSHED_MODULE_VARIANT_END
