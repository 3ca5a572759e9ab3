#include "snowshed/methods/grains/clumps.hpp"

#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::grains {
namespace {

/// Two blocks of n^3 voxels, one on top of the other, with air around.
LabelImage two_blocks(std::size_t n) {
  return image_of(n + 2, n + 2, 2 * n + 2, [n](std::size_t i, std::size_t j, std::size_t k) {
    const auto inside = [](std::size_t x, std::size_t size) { return x >= 1 && x <= size; };
    if (!inside(i, n) || !inside(j, n) || !inside(k, 2 * n)) return 0;
    return k <= n ? 40 : 7;
  });
}

TEST(Clumps, BlocksBecomeShellsWithTheMassOfAllVoxels) {
  for (const std::size_t n : {1, 2, 3, 6}) {
    const Sample sample = make_sample(two_blocks(n));
    ASSERT_EQ(sample.clumps.size(), 2u);
    const std::size_t inner = n > 2 ? (n - 2) * (n - 2) * (n - 2) : 0;
    const double side = double(n) * test_voxel, volume = side * side * side;
    for (const Clump& c : sample.clumps) {
      EXPECT_EQ(c.spheres, n * n * n - inner);
      EXPECT_NEAR(c.volume / volume, 1, 1e-12);
      // A cube of side a has the inertia m a^2 / 6 about any axis.
      EXPECT_TRUE(c.inertia.isApprox(volume * side * side / 6 * Mat3::Identity(), 1e-12));
    }
    EXPECT_EQ(sample.bonds.size(), n * n);
    // Clumps are in the order of labels: the block 7, which is on top, is the first.
    EXPECT_NEAR(sample.clumps[0].center.z() - sample.clumps[1].center.z(), side, 1e-15);
    for (const BondedPair& bond : sample.bonds)
      EXPECT_NEAR((sample.spheres[bond.first] - sample.spheres[bond.second]).norm(),
                  2 * sample.radius, 1e-15);
  }
}

TEST(Clumps, ARodHasTheInertiaOfABox) {
  const Sample sample =
      make_sample(image_of(8, 2, 3, [](std::size_t, std::size_t, std::size_t) { return 1; }));
  const double a = 8 * test_voxel, b = 2 * test_voxel, c = 3 * test_voxel, m = a * b * c;
  const Mat3 box =
      Vec3(m / 12 * (b * b + c * c), m / 12 * (a * a + c * c), m / 12 * (a * a + b * b))
          .asDiagonal();
  EXPECT_TRUE(sample.clumps[0].inertia.isApprox(box, 1e-12));
  EXPECT_EQ(sample.box, Vec3(a, b, c));
}

TEST(Clumps, TheMeasuredSizeMatchesTheSample) {
  const LabelImage image = random_snow(16, 5);
  const Sample sample = make_sample(image);
  const SampleSize size = measure_sample(image);
  EXPECT_EQ(size.grains, sample.clumps.size());
  EXPECT_EQ(size.spheres, sample.spheres.size());
  EXPECT_EQ(size.bonds, sample.bonds.size());
  EXPECT_GE(size.bytes, filled_solver(grains_of(image))->bytes());
}

TEST(Clumps, InvalidImagesAreRefused) {
  const auto uniform = [](int label) {
    return image_of(2, 2, 2, [label](std::size_t, std::size_t, std::size_t) { return label; });
  };
  EXPECT_THROW(make_sample(uniform(0)), InputError);
  EXPECT_THROW(make_sample(uniform(-1)), InputError);
  LabelImage image = uniform(1);
  image.size[0] = 3;
  EXPECT_THROW(make_sample(image), InputError);
  image.size[0] = std::size_t(1) << 62;
  EXPECT_THROW(measure_sample(image), InputError);
  image = uniform(1);
  image.voxel_size = 0;
  EXPECT_THROW(make_sample(image), InputError);
}

}  // namespace
}  // namespace snowshed::methods::grains
