// Impulses at contacts: their parts, moments and centres.
#include "snowshed/methods/contact_impulse.hpp"

#include <gtest/gtest.h>

namespace snowshed::methods {
namespace {

TEST(ContactImpulse, HasAPartAlongTheNormalAndOneAcrossIt) {
  const Vec3 x(1, 0, 2), outward(0, 0, 1);
  const ContactImpulse c = ContactImpulse::at(x, outward, Vec3(3, 0, -4));
  EXPECT_EQ(c.push, 4);
  EXPECT_EQ(c.normal, Vec3(0, 0, -4));
  EXPECT_EQ(c.tangential, Vec3(3, 0, 0));
  EXPECT_EQ(c.total(), Vec3(3, 0, -4));
  EXPECT_EQ(c.moment, Vec3(0, 10, 0));  // z F_x - x F_z about +y
  EXPECT_EQ(c.center(), x);
}

TEST(ContactImpulse, CentreLiesBetweenThePushes) {
  ContactImpulse sum = ContactImpulse::at(Vec3(0, 0, 0), Vec3::UnitZ(), Vec3(0, 0, -3));
  sum += ContactImpulse::at(Vec3(4, 0, 0), Vec3::UnitZ(), Vec3(0, 0, -1));
  EXPECT_EQ(sum.center(), Vec3(1, 0, 0));
  sum.add_at_center(Vec3(0.5, 0, -2));
  EXPECT_EQ(sum.push, 6);
  EXPECT_EQ(sum.center(), Vec3(1, 0, 0));
  EXPECT_EQ(sum.total(), Vec3(0.5, 0, -6));
}

TEST(ContactImpulse, WithoutAPushHasNoCentre) {
  EXPECT_EQ(ContactImpulse().center(), Vec3::Zero());
}

}  // namespace
}  // namespace snowshed::methods
