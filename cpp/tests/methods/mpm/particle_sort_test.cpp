#include "snowshed/methods/mpm/particle_sort.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm {
namespace {

constexpr double cell_size = 0.01;
constexpr Basis basis = Basis::quadratic;

TEST(Placement, FindsBlockAndCell) {
  const auto p = Placement<2>::of(VecD<2>(0.125, -0.005), cell_size, basis);
  EXPECT_EQ(p.block, (BlockCoord<2>{1, -1}));
  EXPECT_NEAR(p.cell[0], 12 - 8, 1e-12);  // 12.5 cells, less the offset 0.5
  EXPECT_NEAR(p.cell[1], -1 + 8, 1e-12);
  EXPECT_THROW((Placement<2>::of(VecD<2>(1e9, 0), cell_size, basis)), SimulationError);
  EXPECT_THROW((Placement<2>::of(VecD<2>(std::nan(""), 0), cell_size, basis)), SimulationError);
}

TEST(Placement, RefusesPositionsBeyondTheKeysOfAField) {
  const double far = (block_coord_limit(1) + 1.5) * block_edge<2> * cell_size;
  EXPECT_NO_THROW((Placement<2>::of(VecD<2>(far, 0), cell_size, basis)));
  EXPECT_THROW((Placement<2>::of(VecD<2>(far, 0), cell_size, basis, 1)), SimulationError);
}

/// Sorts particles; returns their layout.
template <class T, int D>
BlockLayout<D> sorted(Particles<T, D>& particles, const std::vector<BlockKey>& blocks,
                      const BlockLayout<D>& before, int threads) {
  ParticleSort<T, D> sort(particles, blocks, before, threads);
  sort.apply(particles);
  return std::move(sort.layout);
}

template <class T, int D_>
struct SortCase {
  using Scalar = T;
  static constexpr int D = D_;
};

template <class C>
class ParticleSortTest : public testing::Test {
 protected:
  static constexpr int D = C::D;
  using T = typename C::Scalar;
  Particles<T, D> particles;
  std::vector<BlockKey> blocks;
  std::map<std::uint32_t, VecD<D>> positions;  // position by id

  void add_random(std::size_t n, double reach) {
    Random random(9);
    particles.has_plastic = true;
    particles.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto at =
          Placement<D>::of(section<D>(random_vector(random, D, reach)), cell_size, basis);
      // As after some steps, up to a cell outside their block.
      for (int d = 0; d < D; ++d) particles.cell[d][i] = T(at.cell[d] + 2 * random.uniform() - 1);
      blocks.push_back(block_key<D>(at.block));
      particles.id[i] = std::uint32_t(i);
      particles.mass[i] = T(i);
      particles.plastic[i] = T(-double(i));
      positions[std::uint32_t(i)] = position_of(particles, i, blocks[i], cell_size, basis);
    }
  }
};
using SortCases = testing::Types<SortCase<float, 2>, SortCase<float, 3>, SortCase<double, 2>,
                                 SortCase<double, 3>>;
TYPED_TEST_SUITE(ParticleSortTest, SortCases);

TYPED_TEST(ParticleSortTest, PutsEveryParticleIntoItsBlock) {
  constexpr int D = TypeParam::D;
  using T = typename TypeParam::Scalar;
  this->add_random(6000, 0.3);  // enough to sort in parallel
  const BlockLayout<D> layout = sorted(this->particles, this->blocks, BlockLayout<D>(), 2);
  const auto& p = this->particles;
  ASSERT_EQ(layout.first.size(), layout.particle_blocks.size() + 1);
  EXPECT_EQ(layout.first.front(), 0);
  EXPECT_EQ(layout.first.back(), 6000);
  EXPECT_TRUE(std::is_sorted(layout.particle_blocks.begin(), layout.particle_blocks.end()));
  const std::vector<BlockKey> keys = blocks_of_particles(layout);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::uint32_t id = p.id[i];
    EXPECT_EQ(p.mass[i], T(id));  // all values move with the particle
    EXPECT_EQ(p.plastic[i], T(-double(id)));
    for (int d = 0; d < D; ++d) {
      EXPECT_GE(p.cell[d][i], T(0));
      EXPECT_LT(p.cell[d][i], T(block_edge<D>));
    }
    const double rounding = 16 * std::numeric_limits<T>::epsilon() * cell_size;
    EXPECT_LT((position_of(p, i, keys[i], cell_size, basis) - this->positions[id]).norm(),
              rounding + 1e-15);
  }
}

TYPED_TEST(ParticleSortTest, IsStableAndIdempotent) {
  constexpr int D = TypeParam::D;
  this->add_random(6000, 0.3);
  const BlockLayout<D> layout = sorted(this->particles, this->blocks, BlockLayout<D>(), 2);
  for (std::size_t b = 0; b < layout.particle_blocks.size(); ++b)
    for (int i = layout.first[b] + 1; i < layout.first[b + 1]; ++i)
      ASSERT_LT(this->particles.id[i - 1], this->particles.id[i]);
  const auto before = this->particles.id;
  const BlockLayout<D> again = sorted(this->particles, blocks_of_particles(layout), layout, 1);
  EXPECT_EQ(this->particles.id, before);
  EXPECT_EQ(again.particle_blocks, layout.particle_blocks);
  EXPECT_EQ(again.first, layout.first);
  EXPECT_EQ(again.around_nodes, layout.around_nodes);
}

TYPED_TEST(ParticleSortTest, RefusesInvalidPositions) {
  constexpr int D = TypeParam::D;
  using T = typename TypeParam::Scalar;
  for (T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(), T(1e30)}) {
    this->blocks.clear();
    this->add_random(10, 0.1);
    this->particles.cell[1][7] = bad;
    this->particles.cell[0][9] = bad;  // the error names the first bad particle
    const Particles<T, D> before = this->particles;
    try {
      sorted(this->particles, this->blocks, BlockLayout<D>(), 2);
      FAIL();
    } catch (const SimulationError& error) {
      EXPECT_NE(std::string(error.what()).find("particle 7 "), std::string::npos);
    }
    EXPECT_EQ(this->particles.id, before.id);
    for (int i = 0; i < 7; ++i)  // nor have the particles before it been moved
      EXPECT_EQ(this->particles.cell[0][i], before.cell[0][i]);
  }
}

TEST(ParticleSort, ACellJustBelowZeroStaysInsideItsBlock) {
  // -1e-9 + 8 rounds up to 8.0f, which would be the next block's.
  Particles<float, 2> p;
  p.resize(1);
  p.cell[0][0] = -1e-9f;
  p.cell[1][0] = 3;
  const BlockLayout<2> layout = sorted(p, {block_key<2>({0, 0})}, BlockLayout<2>(), 1);
  EXPECT_EQ(layout.particle_blocks[0], block_key<2>({-1, 0}));
  EXPECT_LT(p.cell[0][0], 8.0f);
}

}  // namespace
}  // namespace snowshed::methods::mpm
