#include "snowshed/methods/mpm/kernel_api.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "methods/mpm/solver_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/material_constants.hpp"
#include "snowshed/methods/mpm/particles.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Full friction of up to four obstacles.
template <class T>
constexpr T full_friction[] = {1, 1, 1, 1};

/// The range of a block's particles along each direction, in cells.
struct Spread {
  double low[3], high[3];
};

/// Returns ranges over the whole tile, over the block's first cell, and over the block along one
/// direction.
template <int D>
std::vector<Spread> spreads() {
  constexpr double edge = block_edge<D>;
  return {{{-1, -1, -1}, {edge + 1, edge + 1, edge + 1}},
          {{0, 0, 0}, {1, 1, 1}},
          {{0, 0, 0}, {edge, 1, 1}},
          {{-1, 0, -1}, {1, edge + 1, 1}},
          {{edge, -1, 0}, {edge + 1, 1, edge}}};
}

/// Sums of all nodes, and the mass's first moment about the tile's first node.
template <int D>
struct GridSums {
  double sums[7] = {}, absolute[7] = {}, moment[D] = {};

  template <class T>
  void add(const T* node, const int (&cell)[D]) {
    for (int c = 0; c < 7; ++c) {
      sums[c] += node[c];
      absolute[c] += std::abs(node[c]);
    }
    for (int d = 0; d < D; ++d) moment[d] += double(node[0]) * cell[d];
  }
};

/// The sums that the surrounding blocks gather from one tile, at the nodes that its particles
/// reach.
template <class T, int D>
GridSums<D> gathered(const Kernels<T>& kernels, const T* tile, int reach) {
  GridSums<D> result;
  for (int block = 0; block < neighbour_count<D>; ++block) {
    if (!reaches<D>(reach, block)) continue;
    const T* tiles[neighbour_count<D>] = {};
    tiles[neighbour_count<D> - 1 - block] = tile;  // its position relative to the block
    AlignedVector<T> sums(std::size_t(block_nodes<D>) * node_values, T(7));  // must be cleared
    kernels.gather(tiles, sums.data());
    for (int k = 0; k < block_nodes<D>; ++k) {
      int cell[D];
      for (int d = D - 1, node = k, around = block; d >= 0; --d) {
        cell[d] = node % block_edge<D> + (around % 3 - 1) * block_edge<D> + 1;
        node /= block_edge<D>;
        around /= 3;
      }
      result.add(&sums[std::size_t(k) * node_values], cell);
    }
  }
  return result;
}

/// Scatters particles of one block, in a random state, to its tile, lets the surrounding blocks
/// gather this tile, and expects exact sums on the nodes.
template <class T, int D>
void expect_exact_sums(const SolverVariant& variant, const Spread& spread) {
  constexpr int n = 37;  // not a multiple of any register's lanes
  Random random(5);
  const auto uniform = [&](double low, double high) {
    return T(low + (high - low) * random.uniform());
  };
  Particles<T, D> particles;
  particles.has_affine = variant.transfer != Transfer::flip;
  particles.has_plastic = true;
  particles.resize(n);
  double mass = 0, momentum[D] = {}, first_moment[D] = {};
  for (int i = 0; i < n; ++i) {
    particles.mass[i] = uniform(1e-3, 2e-3);
    particles.plastic[i] = T(-0.1);
    for (auto& c : particles.be_minus_identity) c[i] = uniform(-1e-3, 1e-3);
    if (particles.has_affine)
      for (auto& c : particles.affine) c[i] = uniform(-10, 10);
    mass += particles.mass[i];
    for (int d = 0; d < D; ++d) {
      const T low = T(spread.low[d]), end = std::nextafter(T(spread.high[d]), T(0));
      particles.cell[d][i] = i == 0 ? low : i == 1 ? end : std::min(uniform(low, end), end);
      particles.velocity[d][i] = uniform(-1, 1);
      momentum[d] += double(particles.mass[i]) * particles.velocity[d][i];
      first_moment[d] +=
          double(particles.mass[i]) * (particles.cell[d][i] + base_offset(variant.basis) + 1);
    }
  }
  const Kernels<T> kernels =
      select_kernels<T>({D, variant.transfer, variant.basis, material::SnowModel::cam_clay, false});
  // Values that are not cleared must not be read.
  constexpr T unset = std::numeric_limits<T>::quiet_NaN();
  AlignedVector<T> tile(std::size_t(tile_nodes<D>(variant.basis)) * node_values, unset);
  const auto snow = material_constants<T>(material::Snow(), D);
  const StepParameters<T> step{T(1e-4), T(0.01), T(9.81), T(0.99),         T(0.02),
                               T(0),    T(0),    &snow,   full_friction<T>};
  BlockStats stats;
  kernels.scatter(step, particles.view(), 0, n, tile.data(), stats);
  ASSERT_FALSE(stats.escaped);
  for (int d = 0; d < D; ++d) EXPECT_EQ((stats.reach & below(d)) != 0, spread.low[d] < 0);

  const GridSums<D> grid = gathered<T, D>(kernels, tile.data(), stats.reach);
  const double eps = variant.epsilon();
  EXPECT_NEAR(grid.sums[0], mass, 16 * eps * mass);  // sum of some hundred nodes
  for (int d = 0; d < D; ++d) {
    EXPECT_NEAR(grid.sums[1 + d], momentum[d], 8 * eps * grid.absolute[1 + d]);
    EXPECT_NEAR(grid.sums[4 + d], 0.0, 8 * eps * grid.absolute[4 + d]);  // internal forces
    EXPECT_GT(grid.absolute[4 + d], 1.0);
    EXPECT_NEAR(grid.moment[d], first_moment[d], 8 * eps * mass * tile_edge<D>(variant.basis));
  }
}

template <int D>
void expect_exact_sums_everywhere(const SolverVariant& variant) {
  for (const Spread& spread : spreads<D>()) {
    SCOPED_TRACE(testing::PrintToString(spread.low) + testing::PrintToString(spread.high));
    variant.precision == Precision::float32 ? expect_exact_sums<float, D>(variant, spread)
                                            : expect_exact_sums<double, D>(variant, spread);
  }
}

TEST(Scatter, KeepsMassMomentumAndCenterOfMass) {
  for (const SolverVariant& variant : all_solver_variants()) {
    SCOPED_TRACE(variant.name());
    variant.dimension == 2 ? expect_exact_sums_everywhere<2>(variant)
                           : expect_exact_sums_everywhere<3>(variant);
  }
}

TEST(Scatter, ReportsParticlesOutsideTheTile) {
  Particles<float, 2> particles;
  particles.has_plastic = true;
  particles.resize(3);
  for (auto& c : particles.cell) std::fill(c.begin(), c.end(), 3.0f);
  for (auto& v : particles.velocity) std::fill(v.begin(), v.end(), 0.0f);
  for (auto& s : particles.be_minus_identity) std::fill(s.begin(), s.end(), 0.0f);
  std::fill(particles.mass.begin(), particles.mass.end(), 1.0f);
  std::fill(particles.plastic.begin(), particles.plastic.end(), 0.0f);
  const Kernels<float> kernels = select_kernels<float>(
      {2, Transfer::flip, Basis::quadratic, material::SnowModel::cam_clay, false});
  AlignedVector<float> tile(std::size_t(tile_nodes<2>(Basis::quadratic)) * node_values);
  const auto snow = material_constants<float>(material::Snow(), 2);
  const StepParameters<float> step{
      1e-4f, 0.01f, 9.81f, 0.99f, 0.02f, 0.0f, 0.0f, &snow, full_friction<float>};
  for (float cell : {-1.01f, 9.0f, std::nanf("")}) {
    particles.cell[1][2] = cell;
    BlockStats stats;
    kernels.scatter(step, particles.view(), 0, 3, tile.data(), stats);
    EXPECT_TRUE(stats.escaped) << cell;
  }
}

/// Runs in a process of its own, because kernels are chosen only once.
[[noreturn]] void choose_kernels(const char* name) {
  setenv("SNOWSHED_KERNELS", name, 1);
  try {
    std::fprintf(stderr, "chose %s", kernel_variant_name());
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s", error.what());
  }
  std::exit(0);
}

TEST(KernelChoiceDeathTest, AcceptsOnlyTheNamesOfItsVariants) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto exited = testing::ExitedWithCode(0);
  EXPECT_EXIT(choose_kernels("baseline"), exited, "chose baseline");
  EXPECT_EXIT(choose_kernels("avx-2"), exited,
              "SNOWSHED_KERNELS: is \"avx-2\"; allowed: baseline, avx2, avx512; this machine can "
              "run: baseline");
}

}  // namespace
}  // namespace snowshed::methods::mpm
