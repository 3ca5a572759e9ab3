// The end of a step: velocities after all forces, and new places of the particles on the ground.
#pragma once

#include "snowshed/methods/slide/kernels/bond_forces.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::slide)

inline constexpr double min_slide_speed = 1e-6;  // m/s
inline constexpr double at_rest = 2e-15;         // m/s, above the rounding error of a root

/// A velocity after friction, and the time for which the particle moves, s.
struct PackSlowed {
  PackVec velocity;
  Pack moving;
};

/// Coulomb friction as a set-valued law: it stops snow, and holds it while the driving force is
/// smaller than friction. The part that grows with the square of the speed is implicit: s' + drag
/// dt s'^2 = s.
SNOWSHED_INLINE PackSlowed slowed(const View& s, const PackVec& u, const Pack& yield,
                                  const Pack& drag) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack square = max(dot(u, u), broadcast<Pack>(min_square));
  const Pack per_speed = inverse_sqrt(square);
  const Pack rest = max(Pack{}, Pack(square * per_speed - dt * yield));
  const Pack after = 2.0 * rest / (1.0 + length_from(Pack(1.0 + 4.0 * drag * dt * rest)));
  return {Pack(after * per_speed) * u, dt};
}

/// AvaFrame's default friction: a rate that divides by the earlier speed.
SNOWSHED_INLINE PackSlowed slowed_implicitly(const View& s, const PackVec& u, const Pack& stress,
                                             const Pack& speed) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack rate = stress / max(speed, broadcast<Pack>(min_slide_speed));
  return {Pack(1.0 / (1.0 + dt * rate)) * u, dt};
}

SNOWSHED_INLINE PackSlowed slowed_explicitly(const View& s, const PackVec& u, const Pack& stress,
                                             const Pack& before) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const Pack square = max(dot(u, u), broadcast<Pack>(min_square));
  const Pack per_speed = inverse_sqrt(square), speed = square * per_speed;
  const PackMask moves = speed >= dt * stress;
  const Pack left = select(moves, Pack(1.0 - dt * stress * per_speed), Pack{});
  const Pack until_rest = speed / max(stress, broadcast<Pack>(min_square));
  return {left * u, select(moves, dt, select(before > at_rest, until_rest, Pack{}))};
}

SNOWSHED_INLINE PackSlowed slowed_by(const View& s, const Lanes& l, const PackVec& u) {
  const Pack yield = l.load(s.yield), drag = l.load(s.drag), speed = l.load(s.speed);
  if (s.scheme == FrictionScheme::set_valued) return slowed(s, u, yield, drag);
  const Pack stress = yield + drag * speed * speed;  // m/s2
  return s.scheme == FrictionScheme::avaframe_implicit ? slowed_implicitly(s, u, stress, speed)
                                                       : slowed_explicitly(s, u, stress, speed);
}

/// The velocity turned along the ground, with the speed that it had.
SNOWSHED_INLINE PackVec along_ground(const PackVec& u, const PackVec& normal, double added_speed) {
  const PackVec tangential = u - dot(u, normal) * normal;
  const Pack speed = length_from(dot(tangential, tangential));
  return Pack(length_from(dot(u, u)) / (speed + added_speed)) * tangential;
}

/// A velocity after all forces, and the place to which it leads.
struct PackMotion {
  PackVec velocity;
  PackVec to;
  PackMask moves;  // resting snow stays where it is, to the last bit
  PackReprojection on_ground;
};

/// The acceleration by all loads except friction, which acts later.
SNOWSHED_INLINE PackVec acceleration(const View& s, const Lanes& l) {
  const PackRecord force = taken_apart([&](int k) SNOWSHED_INLINE_LAMBDA {
    const std::ptrdiff_t i = l.first + (k < l.count ? k : 0);
    return Quad(load_row(s.pressure_force + 4 * i) + pull_on(s, i));
  });
  const PackVec a =
      l.load(s.ax, s.ay, s.az) + Pack(1.0 / l.load(s.mass)) * PackVec{force.a, force.b, force.c};
  l.store(s.ax, s.ay, s.az, a);
  return a;
}

SNOWSHED_INLINE void accelerate(const View& s, const Lanes& l, PackMotion& motion) {
  const Pack dt = broadcast<Pack>(s.time_step);
  const PackVec before = l.load(s.ux, s.uy, s.uz);
  const PackSlowed slow = slowed_by(s, l, before + dt * acceleration(s, l));
  const PackVec twice = before + slow.velocity;
  motion.velocity = slow.velocity;
  motion.moves = dot(twice, twice) > 0.0;
  motion.to = l.load(s.x, s.y, s.z) + Pack(0.5 * slow.moving) * twice;
}

/// Stores the new places of particles; returns their kinetic energy, J.
SNOWSHED_INLINE Pack arrive(const View& s, const Lanes& l, const PackMotion& motion) {
  const PackReprojection& r = motion.on_ground;
  const PackGround ground = ground_at(s, r.on_ground);
  const PackMask stays = r.on_ground.inside & ground.known;
  const PackVec u = along_ground(motion.velocity, ground.normal, s.added_speed);
  l.store(s.x, s.y, s.z, {r.x, r.y, select(motion.moves, ground.height, motion.to.z)});
  l.store(s.ux, s.uy, s.uz, u);
  store_place(s, l, r.on_ground, ground.normal);
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
  for (int k = 0; k < packs; ++k) kinetic += arrive(s, lanes_of(begin, end, k), motion[k]);
  return sum_of_lanes(kinetic);
}

SNOWSHED_MODULE_VARIANT_END
