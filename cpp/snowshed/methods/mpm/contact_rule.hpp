// The impulse of an obstacle on the snow of a node. A graphics card compiles this file, too.
#pragma once

#include <cmath>

#include "snowshed/core/simd_pack.hpp"
#include "snowshed/methods/condition.hpp"
#include "snowshed/methods/mpm/contact.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)

/// Rates at which stored impulses decay in a step.
template <class T>
struct FrictionRates {
  T least;      // dt over the friction memory
  T per_speed;  // s/m, the same per m/s of sliding speed

  /// Returns the share of its stored normal impulse for which a contact exerts friction in a step.
  /// `speed` is the sliding speed, m/s.
  SNOWSHED_INLINE T decay_share(T speed) const {
    const T rate = per_speed * speed;
    return rate < least ? least : rate < T(1) ? rate : T(1);
  }
};

/// The way in which a contact acted.
template <class T>
struct ContactOutcome {
  bool lets_go;  // whether the snow has left, or the pull exceeds what the contact holds
  T slip_share;  // share of the sliding velocity that friction takes
};

/// Returns the largest pull that a contact can cancel in a step, as a negative push (N s). A
/// larger pull releases the snow. `stored` is what remains of earlier pushes.
template <class T>
SNOWSHED_INLINE T min_push(const Contact<T>& c, T stored) {
  if (c.release == Release::never) return T(-3e38);  // below any pull
  return c.release == Release::after_push ? -stored : T(0);
}

/// Returns the speed at which snow slides along a contact.
template <int D, class T, class Velocity>
SNOWSHED_INLINE T sliding_speed(const Contact<T>& c, T normal_speed, const Velocity& free) {
  T squared = 0;
  for (int d = 0; d < D; ++d) {
    const T sliding = free[d] - c.velocity[d] - normal_speed * c.normal[d];
    squared += sliding * sliding;
  }
  return sqrt(squared);
}

/// Applies slip or separate (thesis, section 1.2.3) to the velocity of a node, with Coulomb
/// friction on the running mean of the net normal impulse. Each contact stores a normal impulse:
/// pushes on the obstacle add to it, pulls subtract from it, and it decays at the rate 1/(friction
/// memory). The friction of a step follows from the part that decays in it, so that every
/// newton-second of net push counts once. The usual rule applies the friction of each step's push
/// at once. It overestimates the friction of a slab that vibrates on its panel, because slip
/// cancels the pulls but forgets them. The slab may even be held where it should slide.
///
/// Slip cancels any pull, so its stored impulse may become negative. It then causes no friction
/// until later pushes have made it positive. Separate releases snow when the pull exceeds the
/// stored impulse.
///
/// The stored impulse stays at the node while the snow moves on, so friction must act on fast
/// snow before it has left. The impulse therefore decays within the time in which the snow slides
/// over a given part of a cell, or sooner. It decays at once if the snow separates.
///
/// `friction_share` is that of the obstacle (Contacts::find_friction_shares), and
/// coefficient(speed, impulse) Coulomb's coefficient at a sliding speed and a normal impulse.
template <int D, class T, class Velocity, class Coefficient>
SNOWSHED_INLINE ContactOutcome<T> push_and_rub(const FrictionRates<T>& rates, Contact<T>& c, T mass,
                                               T friction_share, const Coefficient& coefficient,
                                               Velocity& node) {
  ContactOutcome<T> outcome;
  T normal_speed = 0;
  for (int d = 0; d < D; ++d) normal_speed += (node[d] - c.velocity[d]) * c.normal[d];
  const T decayed = c.normal_impulse *
                    (c.acts ? rates.decay_share(sliding_speed<D>(c, normal_speed, node)) : T(1));
  const T remaining_impulse = c.normal_impulse - decayed;
  const T min_impulse = c.acts ? min_push(c, remaining_impulse) : T(0);
  T push = c.acts ? -mass * normal_speed : T(0);
  outcome.lets_go = !c.acts || push < min_impulse;
  if (outcome.lets_go) push = min_impulse;
  c.next_normal_impulse = remaining_impulse + push;

  T pushed[D], slip[D], slip_squared = 0;
  const T along = normal_speed + push / mass;  // normal speed that remains
  for (int d = 0; d < D; ++d) {
    pushed[d] = node[d] + push / mass * c.normal[d];
    slip[d] = pushed[d] - c.velocity[d] - along * c.normal[d];
    slip_squared += slip[d] * slip[d];
  }
  const T slip_speed = sqrt(slip_squared);
  const T slip_impulse = mass * slip_speed;
  const T due = decayed > T(0) ? decayed : T(0);
  const T friction = coefficient(slip_speed, due) * friction_share * due;
  outcome.slip_share =
      slip_impulse > friction ? friction / slip_impulse : (friction >= T(0) ? T(1) : friction);
  for (int d = 0; d < D; ++d) node[d] = pushed[d] - outcome.slip_share * slip[d];
  return outcome;
}

SNOWSHED_MODULE_VARIANT_END
