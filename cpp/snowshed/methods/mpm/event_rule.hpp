// The contact between the snow of two events at a node: where it may be, its normal, and the
// impulses of a step. A graphics card compiles this file, too.
#pragma once

#include <cmath>

#include "snowshed/methods/mpm/contact_rule.hpp"

namespace snowshed::methods::mpm {

/// Smallest mass (kg) of a field at a node that counts. Nodes that a field barely reaches do not
/// show where its surface is.
inline constexpr double min_shared_mass = 1e-12;

template <class T>
bool is_shared(T first_mass, T second_mass) {
  return double(first_mass) > min_shared_mass && double(second_mass) > min_shared_mass;
}

/// Number of nodes on either side over which normals are smoothed. With fewer nodes the roughness
/// of two layers of particles brakes sliding snow. In three dimensions a smaller number suffices,
/// because it covers more nodes.
template <int D>
inline constexpr int normal_smoothing = D == 2 ? 6 : 3;
/// Number of nodes around a block whose masses are needed for its normals.
template <int D>
inline constexpr int normal_margin = normal_smoothing<D> + 1;

/// Finds the normal of a shared node, from the first field to the second, times the product of
/// their masses there (kg2): the direction of the gradient of the difference of the two masses.
/// `first` and `second` point to the node in arrays with `edge` nodes along each direction. Returns
/// false if the masses show no direction.
template <int D, class T>
bool find_weighted_normal(const T* first, const T* second, int edge, double (&normal)[D]) {
  double squared = 0;
  for (int d = D - 1, stride = 1; d >= 0; --d, stride *= edge) {
    normal[d] = (double(second[stride]) - double(second[-stride])) -
                (double(first[stride]) - double(first[-stride]));
    squared += normal[d] * normal[d];
  }
  const double length = std::sqrt(squared);
  if (!(length > 0)) return false;
  for (double& component : normal) component *= double(*first) * double(*second) / length;
  return true;
}

/// Weight of a node in a smoothed normal by its distance (nodes) along a direction.
template <int D>
constexpr int smoothing_tent(int along) {
  const int share = normal_margin<D> - (along < 0 ? -along : along);
  return share > 0 ? share : 0;
}

/// Weight of a node in a smoothed normal: the product over all directions.
template <int D>
int smoothing_weight(const int (&distance)[D]) {
  int weight = 1;
  for (const int along : distance) weight *= smoothing_tent<D>(along);
  return weight;
}

/// Impulses of a step at a node, N s.
template <class T, int D>
struct EventImpulses {
  T push;      // from the first field to the second, along the normal
  T friction;  // friction that is due
  T stopping;  // impulse that ends the slip
  T slip[D];   // direction of the slip

  bool any() const { return push != T(0) || stopping != T(0); }
  /// Friction that is due beyond what stops the node, and what other nodes may use of theirs.
  T excess() const { return friction > stopping ? friction - stopping : T(0); }
  T capacity() const { return stopping > friction ? stopping - friction : T(0); }
  /// The friction of the step, if the node takes a share of the excess of others.
  T rubbing(T used_share) const {
    return friction < stopping ? friction + used_share * (stopping - friction) : stopping;
  }
};

/// Returns the share of the capacities that the excess of a block's nodes uses.
template <class T>
T used_share(T excess, T capacity) {
  if (!(excess > T(0) && capacity > T(0))) return T(0);
  return excess < capacity ? excess / capacity : T(1);
}

/// Finds the impulses of a step, and the contact's stored impulse after it. The rules are those of
/// push_and_rub. `difference` is the velocity of the first field relative to the second, m/s.
template <int D, class T, class Contact>
EventImpulses<T, D> event_impulses(const FrictionRates<T>& rates, T friction, T first_mass,
                                   T second_mass, const T (&difference)[D], Contact& c) {
  EventImpulses<T, D> i{};
  if (!is_shared(first_mass, second_mass)) {
    c.next_impulse = 0;
    return i;
  }
  const T reduced = first_mass * (second_mass / (first_mass + second_mass));
  T along = 0, squared = 0;
  for (int d = 0; d < D; ++d) along += difference[d] * c.normal[d];
  for (int d = 0; d < D; ++d) {
    i.slip[d] = difference[d] - along * c.normal[d];
    squared += i.slip[d] * i.slip[d];
  }
  const T speed = std::sqrt(squared);
  for (T& component : i.slip) component = speed > T(0) ? component / speed : T(0);
  const T decayed = c.touches ? c.impulse * rates.decay_share(speed) : c.impulse;
  const T left = c.impulse - decayed, push = reduced * along;
  if (c.touches) i.push = push > -left ? push : -left;
  i.friction = friction * decayed;
  i.stopping = reduced * speed;
  c.next_impulse = left + i.push;
  return i;
}

}  // namespace snowshed::methods::mpm
