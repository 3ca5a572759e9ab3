#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "snowshed/core/random.hpp"
#include "snowshed/methods/mpm/kernels/transfer_rules.hpp"

namespace snowshed::methods::mpm {
namespace {

template <class T, int dimension, Transfer transfer, Basis b>
struct SumsCase {
  using Scalar = T;
  static constexpr int D = dimension;
  static constexpr Basis basis = b;
  static constexpr bool affine = transfer != Transfer::flip;
  using Rule = TransferRule<T, dimension, transfer, b>;
};

/// A chunk of particles anywhere in a block, and a tile of nodes around it.
template <class C>
class NodeSumsTest : public testing::Test {
 protected:
  using T = typename C::Scalar;
  static constexpr int D = C::D, S = support(C::basis), N = tile_edge<D>(C::basis);
  static constexpr int W = simd_width<T>;
  /// Number of values per node that particles read. Further values repeat these.
  static constexpr int taken = C::Rule::taken == Halves::first ? half_node : node_values;
  static constexpr double epsilon = std::numeric_limits<T>::epsilon();

  NodeSumsTest() : tile(tile_nodes<D>(C::basis) * node_values) {
    Random random(5);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const bool repeated = i % node_values >= taken;
      tile[i] = repeated ? tile[i - taken] : T(2 * random.uniform() - 1);
    }
    for (auto& lanes : cell)
      for (int l = 0; l < W; ++l) lanes[l] = T(random.uniform() * (block_edge<D> + 2) - 1);
  }

  /// Calls f(node's values, weight, its gradient, distance to the node) for a particle's nodes.
  template <class Values, class F>
  void for_each_node(Values* values, int lane, F f) const {
    double w[D][S], g[D][S], arm[D][S];
    int lowest[D];
    for (int d = 0; d < D; ++d) {
      const double x = cell[d][lane];
      lowest[d] = int(std::floor(x));
      BSpline<C::basis>::evaluate(x - lowest[d], w[d], g[d]);
      for (int k = 0; k < S; ++k) arm[d][k] = k - (x - lowest[d]) - base_offset(C::basis);
    }
    for (int node = 0; node < (D == 3 ? S * S * S : S * S); ++node) {
      int k[D], index = 0;
      for (int d = D - 1, rest = node; d >= 0; --d, rest /= S) k[d] = rest % S;
      for (int d = 0; d < D; ++d) index = index * N + lowest[d] + 1 + k[d];
      double weight = 1, gradient[D], distance[D];
      for (int d = 0; d < D; ++d) weight *= w[d][k[d]];
      for (int d = 0; d < D; ++d) {
        gradient[d] = 1;
        for (int e = 0; e < D; ++e) gradient[d] *= e == d ? g[e][k[e]] : w[e][k[e]];
        distance[d] = arm[d][k[d]];
      }
      f(values + index * node_values, weight, gradient, distance);
    }
  }

  std::vector<T> tile;
  SimdPack<T> cell[D];
};

using SumsCases = testing::Types<SumsCase<float, 2, Transfer::flip, Basis::quadratic>,
                                 SumsCase<float, 3, Transfer::flip, Basis::quadratic>,
                                 SumsCase<double, 3, Transfer::flip, Basis::quadratic>,
                                 SumsCase<float, 3, Transfer::flip, Basis::cubic>,
                                 SumsCase<double, 2, Transfer::flip, Basis::cubic>,
                                 SumsCase<float, 3, Transfer::apic, Basis::quadratic>,
                                 SumsCase<double, 3, Transfer::apic, Basis::quadratic>,
                                 SumsCase<float, 2, Transfer::apic, Basis::cubic>,
                                 SumsCase<double, 3, Transfer::apic, Basis::cubic>,
                                 SumsCase<float, 2, Transfer::affine_flip, Basis::quadratic>,
                                 SumsCase<float, 3, Transfer::affine_flip, Basis::quadratic>,
                                 SumsCase<double, 3, Transfer::affine_flip, Basis::cubic>>;
TYPED_TEST_SUITE(NodeSumsTest, SumsCases);

TYPED_TEST(NodeSumsTest, InterpolationMatchesASumOverTheNodes) {
  using Fixture = TestFixture;
  using T = typename Fixture::T;
  constexpr int D = Fixture::D;
  const Stencil<T, D, TypeParam::basis> stencil(this->cell);
  ASSERT_TRUE(stencil.inside);
  const typename TypeParam::Rule::Interpolation weights(stencil);
  for (int l = 0; l < Fixture::W; ++l) {
    const auto sums = interpolate_nodes<typename TypeParam::Rule, T, D, TypeParam::basis>(
        weights, l, this->tile.data() + stencil.address[l]);
    double value[node_values] = {}, along[D][node_values] = {};
    this->for_each_node(this->tile.data(), l,
                        [&](const T* node, double w, const double* gradient, const double* arm) {
                          for (int i = 0; i < node_values; ++i) {
                            value[i] += w * node[i];
                            for (int d = 0; d < D; ++d)
                              along[d][i] +=
                                  (i < half_node ? gradient[d] : w * arm[d]) * node[i % half_node];
                          }
                        });
    T result[node_values];
    sums.value.template store<TypeParam::Rule::taken>(result);
    for (int i = 0; i < Fixture::taken; ++i) EXPECT_NEAR(result[i], value[i], 32 * this->epsilon);
    for (int d = 0; d < D; ++d) {
      sums.along[d].store(result);
      for (int i = 0; i < TypeParam::Rule::derived_values; ++i)
        EXPECT_NEAR(result[i], along[d][i], 64 * this->epsilon);
    }
  }
}

TYPED_TEST(NodeSumsTest, UniformMotionHasNoGradient) {
  using T = typename TestFixture::T;
  constexpr int D = TestFixture::D;
  std::fill(this->tile.begin(), this->tile.end(), T(0.3));
  const Stencil<T, D, TypeParam::basis> stencil(this->cell);
  const typename TypeParam::Rule::Interpolation weights(stencil);
  for (int l = 0; l < TestFixture::W; ++l) {
    const auto sums = interpolate_nodes<typename TypeParam::Rule, T, D, TypeParam::basis>(
        weights, l, this->tile.data() + stencil.address[l]);
    T result[node_values];
    sums.value.template store<TypeParam::Rule::taken>(result);
    for (int i = 0; i < TestFixture::taken; ++i) EXPECT_EQ(result[i], T(0.3));
    for (int d = 0; d < D; ++d) {
      sums.along[d].store(result);
      for (int i = 0; i < half_node; ++i) EXPECT_EQ(result[i], T(0));
    }
  }
}

TYPED_TEST(NodeSumsTest, ScatteringMatchesASumOverTheNodes) {
  using T = typename TestFixture::T;
  using Rule = typename TypeParam::Rule;
  constexpr int D = TestFixture::D;
  const Stencil<T, D, TypeParam::basis> stencil(this->cell);
  const typename Rule::Scattering weights(stencil);
  Random random(6);
  for (int l = 0; l < TestFixture::W; ++l) {
    T row[half_node * Rule::given_halves];
    for (T& value : row) value = T(2 * random.uniform() - 1);
    NodeSums<T, D> sums;
    const T* nothing = nullptr;
    sums.value = Node<T>::of_halves(row, nothing);
    for (int d = 0; d < D; ++d) sums.along[d] = Rule::given(row, d);
    std::vector<double> expected(this->tile.begin(), this->tile.end());
    this->for_each_node(expected.data(), l,
                        [&](double* node, double w, const double* gradient, const double* arm) {
                          for (int i = 0; i < half_node; ++i) {
                            node[i] += w * row[i];
                            for (int d = 0; d < D; ++d) {
                              node[half_node + i] += gradient[d] * row[half_node * (1 + d) + i];
                              if (TypeParam::affine)
                                node[i] += w * arm[d] * row[half_node * (1 + D + d) + i];
                            }
                          }
                        });
    scatter_nodes<Rule, T, D, TypeParam::basis>(weights, l, sums,
                                                this->tile.data() + stencil.address[l]);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(this->tile[i], expected[i], 16 * this->epsilon);
  }
}

TYPED_TEST(NodeSumsTest, ParticlesOutsideTheTileAreDetected) {
  using T = typename TestFixture::T;
  constexpr int D = TestFixture::D;
  for (const T x : {T(-1.01), T(block_edge<D> + 1), std::numeric_limits<T>::quiet_NaN()}) {
    const auto before = this->cell[D - 1];
    this->cell[D - 1][1] = x;
    EXPECT_FALSE((Stencil<T, D, TypeParam::basis>(this->cell).inside)) << x;
    this->cell[D - 1] = before;
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
