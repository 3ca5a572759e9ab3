// The impulse that snow gives to an obstacle at its contacts.
#pragma once

#include "snowshed/core/vec.hpp"

namespace snowshed::methods {

/// Sums over contacts; per metre of width in 2D. Divided by a time they are forces.
struct ContactImpulse {
  Vec3 normal = Vec3::Zero();       // N s, along the normals of the contacts
  Vec3 tangential = Vec3::Zero();   // N s, across the normals
  Vec3 moment = Vec3::Zero();       // N m s, about the origin of the scene
  double push = 0;                  // N s, sum of the normal impulses; a pull is negative
  Vec3 push_moment = Vec3::Zero();  // N m s, sum of the normal impulses times their positions

  /// The impulse on an obstacle at a point x of its surface with this outward normal.
  static ContactImpulse at(const Vec3& x, const Vec3& outward, const Vec3& impulse) {
    ContactImpulse c;
    c.push = -impulse.dot(outward);
    c.normal = -c.push * outward;
    c.tangential = impulse - c.normal;
    c.moment = x.cross(impulse);
    c.push_moment = c.push * x;
    return c;
  }

  Vec3 total() const { return normal + tangential; }
  /// The centre of pressure, m; the origin if nothing presses.
  Vec3 center() const { return push > 0 ? Vec3(push_moment / push) : Vec3(Vec3::Zero()); }

  /// Calls f with each number.
  template <class Self, class F>
  static void for_each_number(Self& self, const F& f) {
    for (auto* v : {&self.normal, &self.tangential, &self.moment, &self.push_moment})
      for (int d = 0; d < 3; ++d) f((*v)[d]);
    f(self.push);
  }

  ContactImpulse& operator+=(const ContactImpulse& other) { return add(other, 1); }
  ContactImpulse& add(const ContactImpulse& other, double factor) {
    normal += factor * other.normal;
    tangential += factor * other.tangential;
    moment += factor * other.moment;
    push += factor * other.push;
    push_moment += factor * other.push_moment;
    return *this;
  }
  friend ContactImpulse operator*(double factor, const ContactImpulse& c) {
    return ContactImpulse().add(c, factor);
  }
  friend ContactImpulse operator-(ContactImpulse a, const ContactImpulse& b) {
    return a.add(b, -1);
  }

  /// Adds an impulse at the centre of pressure. Its part along the mean normal presses.
  void add_at_center(const Vec3& impulse) {
    const Vec3 along = normal.stableNormalized(), x = center();
    const double share = impulse.dot(along);
    normal += share * along;
    tangential += impulse - share * along;
    moment += x.cross(impulse);
    push += share;
    push_moment += share * x;
  }
};

}  // namespace snowshed::methods
