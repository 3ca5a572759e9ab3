// Helpers shared by the tests of geometry/.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/random.hpp"
#include "snowshed/geometry/bounds.hpp"
#include "snowshed/geometry/level_set.hpp"

namespace snowshed::geometry_testing {

/// Returns a point uniformly distributed in the cube [-half, half]^3.
inline Vec3 random_point(Random& random, double half) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return half * (2 * Vec3(x, y, z) - Vec3::Ones());
}

inline Mat3 random_rotation(Random& random) {
  const Vec3 axis = random_point(random, 1.0).normalized();
  return Eigen::AngleAxisd(2 * pi * random.uniform(), axis).toRotationMatrix();
}

/// Expects that the normal is a unit vector and the gradient of the distance at random points. Few
/// points lie so close to the medial axis that the gradient differs.
inline void expect_normal_is_gradient(const geometry::LevelSet& shape, double half,
                                      double tolerance = 1e-5, double h = 1e-6) {
  Random random(7);
  int off = 0;
  constexpr int samples = 2000;
  for (int n = 0; n < samples; ++n) {
    const Vec3 x = random_point(random, half);
    Vec3 gradient;
    for (int i = 0; i < 3; ++i) {
      const Vec3 step = h * Vec3::Unit(i);
      gradient[i] = (shape.distance(x + step) - shape.distance(x - step)) / (2 * h);
    }
    ASSERT_NEAR(shape.normal(x).norm(), 1.0, 1e-9);
    off += (gradient - shape.normal(x)).norm() > tolerance;
  }
  EXPECT_LE(off, samples / 200);
}

/// Expects that every point with a negative distance lies within the bounds.
inline void expect_bounds_hold(const geometry::LevelSet& shape, double half) {
  Random random(8);
  const geometry::Bounds bounds = shape.bounds();
  int inside = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = random_point(random, half);
    if (shape.distance(x) >= 0) continue;
    ++inside;
    ASSERT_TRUE((x.array() >= bounds.min.array()).all() && (x.array() <= bounds.max.array()).all())
        << x.transpose();
  }
  EXPECT_GT(inside, 0);
}

/// Expects that `action` throws an InputError whose text contains `expected`.
template <class Action>
void expect_input_error(Action action, const std::string& expected) {
  try {
    action();
    ADD_FAILURE() << "no InputError; expected one with '" << expected << "'";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos)
        << "'" << error.what() << "' lacks '" << expected << "'";
  }
}

/// A temporary folder, removed at the end of its scope.
class TempDir {
 public:
  TempDir() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("snowshed_" + std::string(info->test_suite_name()) + "_" + info->name() + "_" +
             std::to_string(reinterpret_cast<std::size_t>(this)));
    std::filesystem::create_directories(path_);
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace snowshed::geometry_testing
