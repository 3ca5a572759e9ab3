#include "snowshed/methods/mps/elastic_strain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace snowshed::methods::mps {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector3d;

// A step of a rotation turns the strain by an angle of 2 atan(w dt/2), and leaves its size.
TEST(MpsElasticStrain, TurnsWithTheSnow) {
  const Vector3d spin(0.3, -0.5, 0.8);
  Matrix3d strain, gradient;
  strain << 2, 1, -1, 1, 0, 3, -1, 3, 1;
  strain *= 1e-5;
  gradient << 0, -spin.z(), spin.y(), spin.z(), 0, -spin.x(), -spin.y(), spin.x(), 0;
  const double dt = 0.7, angle = 2 * std::atan(0.5 * dt * spin.norm());
  const Matrix3d turn = Eigen::AngleAxisd(angle, spin.normalized()).toRotationMatrix();
  const Matrix3d after = strain_after<3>(strain, gradient, dt, 1e-3);
  EXPECT_LT((after - turn * strain * turn.transpose()).norm(), 1e-12 * strain.norm());
}

// In simple shear the strain grows by the shear rate until it yields.
TEST(MpsElasticStrain, GrowsUntilTheSnowYields) {
  const double rate = 0.01, dt = 0.01, yield_strain = 3e-4;
  Matrix2d gradient = Matrix2d::Zero(), strain = Matrix2d::Zero();
  gradient(0, 1) = rate;
  for (int k = 1; k <= 6; ++k) {
    strain = strain_after<2>(strain, gradient, dt, yield_strain);
    EXPECT_NEAR(std::sqrt(2.0) * strain.norm(), std::min(k * rate * dt, yield_strain), 1e-7) << k;
    EXPECT_NEAR(2 * strain(0, 1), std::min(k * rate * dt, yield_strain), 1e-7) << k;
  }
}

// A change of volume is remembered, too.
TEST(MpsElasticStrain, HasATrace) {
  const Matrix2d gradient = -0.01 * Matrix2d::Identity();
  EXPECT_NEAR(strain_after<2>(Matrix2d::Zero(), gradient, 0.01, 1e-3).trace(), -2e-4, 1e-12);
}

}  // namespace
}  // namespace snowshed::methods::mps
