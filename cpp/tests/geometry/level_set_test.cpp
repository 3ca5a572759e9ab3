#include "snowshed/geometry/level_set.hpp"

#include "geometry/geometry_testing.hpp"

namespace snowshed::geometry {
namespace {

using namespace geometry_testing;

// Solids that do not override `normal`.

class Ball final : public LevelSet {
 public:
  double distance(const Vec3& x) const override { return x.norm() - 1; }
  Bounds bounds() const override { return {-Vec3::Ones(), Vec3::Ones()}; }
  double inradius() const override { return 1; }
};

class Slab final : public LevelSet {
 public:
  double distance(const Vec3& x) const override { return std::abs(x.x()) - 1; }
  Bounds bounds() const override { return {-Vec3::Ones(), Vec3::Ones()}; }
  double inradius() const override { return 1; }
};

class Constant final : public LevelSet {
 public:
  double distance(const Vec3&) const override { return 1; }
  Bounds bounds() const override { return {Vec3::Zero(), Vec3::Zero()}; }
  double inradius() const override { return 0; }
};

TEST(LevelSet, DefaultNormalOfABallIsRadial) {
  const Ball ball;
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const Vec3 x = random_point(random, 3.0);
    EXPECT_LT((ball.normal(x) - x.normalized()).norm(), 1e-7);
  }
}

TEST(LevelSet, DefaultNormalIsAUnitVectorWhereTheGradientVanishes) {
  EXPECT_NEAR(Ball().normal(Vec3::Zero()).norm(), 1, 1e-12);
  EXPECT_NEAR(std::abs(Slab().normal(Vec3::Zero()).x()), 1, 1e-9);
  EXPECT_EQ(Constant().normal(Vec3::Zero()), Vec3::UnitZ());
}

TEST(LevelSet, DefaultNormalKeepsItsAccuracyFarFromTheOrigin) {
  const Vec3 x(3e4, -2e4, 1e4);
  EXPECT_LT((Ball().normal(x) - x.normalized()).norm(), 1e-6);
}

}  // namespace
}  // namespace snowshed::geometry
