// The end of a step: velocities after all that acts, and particles on their way over the ground.
#pragma once

#include "snowshed/methods/slide/kernels/places.hpp"

SNOWSHED_VARIANT_BEGIN

inline constexpr double least_slide_speed = 1e-6;  // m/s
inline constexpr double at_rest = 2e-15;           // m/s, above what a root makes of zero

/// A velocity after friction, and for how long the particle moves, s.
struct QuadSlowed {
  QuadVec velocity;
  Quad moving;
};

/// Coulomb friction as a set-valued law: it stops snow, and holds it where what drives it is less.
/// The part that grows with the square of the speed is implicit: s' + drag dt s'^2 = s.
SNOWSHED_INLINE QuadSlowed slowed(const SlideView& s, const QuadVec& u, const Quad& yield,
                                  const Quad& drag) {
  const Quad dt = broadcast<Quad>(s.time_step);
  const Quad square = max(dot(u, u), broadcast<Quad>(least_square));
  const Quad per_speed = inverse_sqrt(square);
  const Quad rest = max(Quad{}, Quad(square * per_speed - dt * yield));
  const Quad after = 2.0 * rest / (1.0 + length_from(Quad(1.0 + 4.0 * drag * dt * rest)));
  return {Quad(after * per_speed) * u, dt};
}

/// As AvaFrame does it by default: a rate that divides by the speed of before.
SNOWSHED_INLINE QuadSlowed slowed_implicitly(const SlideView& s, const QuadVec& u,
                                             const Quad& stress, const Quad& speed) {
  const Quad dt = broadcast<Quad>(s.time_step);
  const Quad rate = stress / max(speed, broadcast<Quad>(least_slide_speed));
  return {Quad(1.0 / (1.0 + dt * rate)) * u, dt};
}

SNOWSHED_INLINE QuadSlowed slowed_explicitly(const SlideView& s, const QuadVec& u,
                                             const Quad& stress, const Quad& before) {
  const Quad dt = broadcast<Quad>(s.time_step);
  const Quad square = max(dot(u, u), broadcast<Quad>(least_square));
  const Quad per_speed = inverse_sqrt(square), speed = square * per_speed;
  const QuadMask moves = speed >= dt * stress;
  const Quad left = select(moves, Quad(1.0 - dt * stress * per_speed), Quad{});
  const Quad until_rest = speed / max(stress, broadcast<Quad>(least_square));
  return {left * u, select(moves, dt, select(before > at_rest, until_rest, Quad{}))};
}

SNOWSHED_INLINE QuadSlowed slowed_by(const SlideView& s, const Lanes& l, const QuadVec& u) {
  const Quad yield = l.load(s.yield), drag = l.load(s.drag), speed = l.load(s.speed);
  if (s.scheme == FrictionScheme::set_valued) return slowed(s, u, yield, drag);
  const Quad stress = yield + drag * speed * speed;  // m/s2
  return s.scheme == FrictionScheme::avaframe_implicit ? slowed_implicitly(s, u, stress, speed)
                                                       : slowed_explicitly(s, u, stress, speed);
}

/// The velocity along the ground, at its speed of before.
SNOWSHED_INLINE QuadVec along_ground(const QuadVec& u, const QuadVec& normal, double added_speed) {
  const QuadVec tangential = u - dot(u, normal) * normal;
  const Quad speed = length_from(dot(tangential, tangential));
  return Quad(length_from(dot(u, u)) / (speed + added_speed)) * tangential;
}

/// Moves up to four particles; returns their kinetic energy, J.
SNOWSHED_INLINE double move_lanes(const SlideView& s, const Lanes& l) {
  const Quad dt = broadcast<Quad>(s.time_step);
  const QuadVec before = l.load(s.ux, s.uy, s.uz);
  const QuadSlowed slow = slowed_by(s, l, before + dt * l.load(s.ax, s.ay, s.az));
  const QuadVec to = l.load(s.x, s.y, s.z) + Quad(0.5 * slow.moving) * (before + slow.velocity);
  QuadReprojection r = reproject(s, to.x, to.y, to.z);
  const QuadMask stays = r.on_ground.inside & is_known(s, r.on_ground);
  const QuadRecord ground = interpolated(s.ground, s.columns, r.on_ground);
  const QuadVec normal = upward(ground.b, ground.c);
  const QuadVec u = along_ground(slow.velocity, normal, s.added_speed);
  l.store(s.x, s.y, s.z, {r.x, r.y, ground.a});
  l.store(s.ux, s.uy, s.uz, u);
  store_place(s, l, r.on_ground, normal);
  const Quad kinetic = 0.5 * l.load(s.mass) * dot(slow.velocity, slow.velocity);
  double sum = 0;
  for (int i = 0; i < l.count; ++i) {
    s.removed[l.first + i] = stays[i] == 0;
    if (stays[i]) sum += kinetic[i];
  }
  return sum;
}

SNOWSHED_VARIANT_END
