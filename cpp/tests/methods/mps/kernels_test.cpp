#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "snowshed/methods/mps/kernel_api.hpp"
#include "snowshed/methods/mps/kernel_function.hpp"
#include "snowshed/methods/mps/moments.hpp"
#include "snowshed/particles/neighbour_lists.hpp"

namespace snowshed::methods::mps {
namespace {

/// A random cloud, partly denser and partly sparser than a lattice, so that row lengths differ.
template <int D>
struct Cloud {
  static constexpr double radius = 2.1;
  AlignedVector<VecD<D>> position, velocity;
  double period;  // along x; 0: none
  particles::NeighbourLists<D> lists;
  std::array<const float*, D> offset;
  PairRows rows;
  AlignedVector<float> weight, slope, sum, filling;

  explicit Cloud(std::size_t count, double repeated = 0)
      : position(count), velocity(count), period(repeated) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(0, 8), speed(-1, 1);
    for (std::size_t i = 0; i < count; ++i)
      for (int d = 0; d < D; ++d) {
        position[i][d] = coordinate(random);
        velocity[i][d] = speed(random);
      }
    particles::CellOrder<D> cells;
    cells.update(position, radius, period);
    const AlignedVector<VecD<D>> unsorted = position;
    for (std::size_t k = 0; k < count; ++k) position[k] = unsorted[cells.order()[k]];
    cells.update(position, radius, period);
    lists.update(position, cells, radius, period, chosen_kernels<D>().search, 1);
    lists.find_mirrors(1);
    for (int d = 0; d < D; ++d) offset[std::size_t(d)] = lists.offset(d);
    rows = {lists.first(), lists.index()};
    weight.resize(lists.pairs());
    slope.resize(lists.pairs());
    sum.resize(count);
    filling.resize(count);
    chosen_kernels<D>().weigh(rows, offset.data(), float(radius), weight.data(), slope.data(),
                              sum.data(), filling.data(), 0, std::ptrdiff_t(count));
  }
  std::ptrdiff_t size() const { return std::ptrdiff_t(position.size()); }
  VecD<D> separation(std::size_t i, std::size_t j) const {
    VecD<D> r = position[j] - position[i];
    if (period > 0) r[0] -= period * std::round(r[0] / period);
    return r;
  }
  template <class F>
  void for_each_pair(const F& f) const {
    for (std::size_t i = 0; i < position.size(); ++i)
      for (std::uint32_t e = lists.begin(i); e < lists.end(i); ++e)
        f(i, std::size_t(lists.neighbour(e)), std::size_t(e));
  }
};

template <class T>
class MpsKernels : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MpsKernels, Dimensions);

TYPED_TEST(MpsKernels, FindTheNeighboursOfABruteForceSearch) {
  constexpr int D = TypeParam::value;
  for (const double period : {0.0, 8.0}) {
    const Cloud<D> cloud(150, period);
    for (std::size_t i = 0; i < 150; ++i) {
      std::set<std::size_t> near, listed;
      for (std::size_t j = 0; j < 150; ++j)
        if (j != i && cloud.separation(i, j).norm() < cloud.radius) near.insert(j);
      for (std::uint32_t e = cloud.lists.begin(i); e < cloud.lists.end(i); ++e) {
        const std::size_t j = cloud.lists.neighbour(e);
        EXPECT_TRUE(listed.insert(j).second);
        EXPECT_LT((cloud.lists.separation(e) - cloud.separation(i, j)).norm(), 1e-6);
      }
      EXPECT_EQ(listed, near);
    }
  }
}

TYPED_TEST(MpsKernels, WeighPairsByTheirDirection) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t half = RowMoments<D>::half;
  const Cloud<D> cloud(150);
  AlignedVector<std::array<float, half>> correction(150);
  for (std::size_t i = 0; i < 150; ++i)
    for (std::size_t k = 0; k < half; ++k)
      correction[i][k] = 0.4f + 0.01f * float((7 * i + 13 * k) % 60);
  AlignedVector<float> corrected(cloud.lists.pairs());
  chosen_kernels<D>().isotropic_weights(cloud.rows, cloud.offset.data(), cloud.weight.data(),
                                        correction.data()->data(), corrected.data(), 0,
                                        cloud.size());
  std::array<int, 3>
      counts{};  // factors at the lower limit, between the limits, at the upper limit
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    const VecD<D> separation = cloud.separation(i, j).normalized();
    const double factor =
        0.5 *
        separation.dot((symmetric<D>(correction[i].data()) + symmetric<D>(correction[j].data())) *
                       separation);
    ++counts[factor < 0.5 ? 0 : factor < 2 ? 1 : 2];
    EXPECT_NEAR(corrected[e], double(cloud.weight[e]) * std::clamp(factor, 0.5, 2.0),
                1e-4 * (1 + double(cloud.weight[e])));
  });
  EXPECT_GT(counts[0], 10);
  EXPECT_GT(counts[1], 10);
}

TYPED_TEST(MpsKernels, WeighAndSumPairs) {
  constexpr int D = TypeParam::value;
  const Cloud<D> cloud(150);
  AlignedVector<RowMoments<D>> moments(150);
  chosen_kernels<D>().sum_moments(cloud.rows, cloud.offset.data(), cloud.weight.data(),
                                  cloud.slope.data(), moments.data(), 0, cloud.size());
  std::vector<double> sum(150), filling(150), last(150), side(150);
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    const VecD<D> r = cloud.position[j] - cloud.position[i];
    const double w = kernel_weight(std::max(r.norm(), 0.01 * cloud.radius), cloud.radius);
    EXPECT_NEAR(cloud.weight[e], w, 1e-5 * (1 + w));
    sum[i] += w;
    filling[i] += filling_weight(w);
    last[i] += w / r.squaredNorm() * r[D - 1] * r[D - 1];
    side[i] += w * r[0];
  });
  for (std::size_t i = 0; i < 150; ++i) {
    EXPECT_NEAR(cloud.sum[i], sum[i], 1e-4 * (1 + sum[i]));
    EXPECT_NEAR(cloud.filling[i], filling[i], 1e-5 * (1 + filling[i]));
    EXPECT_NEAR(moments[i].slope[RowMoments<D>::half - 1], last[i], 1e-3 * (1 + last[i]));
    EXPECT_NEAR(moments[i].side[0], side[i], 1e-4 * (1 + sum[i]));
  }
}

TYPED_TEST(MpsKernels, MultiplyRowsByVectors) {
  constexpr int D = TypeParam::value;
  using Matrix = Eigen::Matrix<double, D, D>;
  const Cloud<D> cloud(150);
  AlignedVector<double> diagonal(150, 3.0), p(150), q(150);
  AlignedVector<Matrix> block(150, Matrix(2 * Matrix::Identity() + 0.5 * Matrix::Ones()));
  AlignedVector<VecD<D>> product(150);
  diagonal[5] = 0;
  block[5].setZero();
  for (std::size_t i = 0; i < 150; ++i) p[i] = cloud.velocity[i][0];
  chosen_kernels<D>().apply(cloud.rows, cloud.weight.data(), diagonal.data(), p.data(), q.data(), 0,
                            cloud.size());
  chosen_kernels<D>().apply_to_velocities(cloud.rows, cloud.weight.data(), block.data()->data(),
                                          cloud.velocity.data()->data(), product.data()->data(), 0,
                                          cloud.size());
  AlignedVector<double> expected(150);
  AlignedVector<VecD<D>> expected_product(150);
  for (std::size_t i = 0; i < 150; ++i) {
    expected[i] = diagonal[i] * p[i];
    expected_product[i] = block[i] * cloud.velocity[i];
  }
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    if (i == 5) return;
    expected[i] -= double(cloud.weight[e]) * p[j];
    expected_product[i] -= double(cloud.weight[e]) * cloud.velocity[j];
  });
  for (std::size_t i = 0; i < 150; ++i) {
    EXPECT_NEAR(q[i], expected[i], 1e-9 * (1 + double(cloud.sum[i])));
    EXPECT_LT((product[i] - expected_product[i]).norm(), 1e-9 * (1 + double(cloud.sum[i])));
  }
}

TYPED_TEST(MpsKernels, SumSeparationsAndApproaches) {
  constexpr int D = TypeParam::value;
  const Cloud<D> cloud(150);
  constexpr double limit = 1.3;
  AlignedVector<double> value(150), base(150), share(150);
  for (std::size_t i = 0; i < 150; ++i) {
    value[i] = cloud.velocity[i][0];
    base[i] = cloud.velocity[i][1];
    share[i] = i % 3 == 0 ? 1.0 : 0.5;
  }
  AlignedVector<VecD<D>> separations(150), weighted(150), approaches(150);
  const auto sum_separations = [&](const double* values, AlignedVector<VecD<D>>& sums) {
    chosen_kernels<D>().sum_separations(cloud.rows, cloud.offset.data(), cloud.slope.data(), values,
                                        base.data(), sums.data()->data(), 0, cloud.size());
  };
  sum_separations(nullptr, separations);
  sum_separations(value.data(), weighted);
  chosen_kernels<D>().sum_approaches(cloud.rows, cloud.offset.data(), cloud.velocity.data()->data(),
                                     share.data(), limit, approaches.data()->data(), 0,
                                     cloud.size());
  AlignedVector<VecD<D>> expected(150, VecD<D>::Zero()), expected_weighted = expected,
                                                         expected_approaches = expected;
  AlignedVector<double> sizes(150, 0.0);
  int distant = 0, receding = 0;
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    const VecD<D> r = cloud.separation(i, j), change = cloud.velocity[j] - cloud.velocity[i];
    expected[i] += double(cloud.slope[e]) * r;
    expected_weighted[i] += double(cloud.slope[e]) * (value[j] + base[i]) * r;
    sizes[i] += double(cloud.slope[e]) * r.norm();
    const double approach = -change.dot(r.normalized());
    distant += r.norm() >= limit;
    receding += approach < 0;
    if (r.norm() < limit && approach > 0)
      expected_approaches[i] += share[j] * approach * r.normalized();
  });
  for (std::size_t i = 0; i < 150; ++i) {
    EXPECT_LT((separations[i] - expected[i]).norm(), 1e-6 * (1 + sizes[i]));
    EXPECT_LT((weighted[i] - expected_weighted[i]).norm(), 1e-6 * (1 + sizes[i]));
    EXPECT_LT((approaches[i] - expected_approaches[i]).norm(), 1e-5);
  }
  EXPECT_GT(distant, 100);
  EXPECT_GT(receding, 100);
}

/// A linear velocity field has the same shear rate at the midpoints of all pairs.
TYPED_TEST(MpsKernels, ComputeTheShearRateOfALinearField) {
  constexpr int D = TypeParam::value;
  using Matrix = Eigen::Matrix<double, D, D>;
  Cloud<D> cloud(150);
  Matrix field;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) field(a, b) = 1.0 + a - 2.5 * b + a * b;
  for (std::size_t i = 0; i < 150; ++i) cloud.velocity[i] = field * cloud.position[i];
  AlignedVector<Matrix> gradient(150);
  chosen_kernels<D>().sum_gradients(cloud.rows, cloud.offset.data(), cloud.slope.data(),
                                    cloud.velocity.data()->data(), gradient.data()->data(), 0,
                                    cloud.size());
  AlignedVector<Matrix> expected(150, Matrix(Matrix::Zero()));
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    expected[i] += double(cloud.slope[e]) * (cloud.velocity[j] - cloud.velocity[i]) *
                   (cloud.position[j] - cloud.position[i]).transpose();
  });
  for (std::size_t i = 0; i < 150; ++i)
    EXPECT_LT((gradient[i] - expected[i]).norm(), 1e-5 * (1 + expected[i].norm()));
  gradient.assign(150, field);
  AlignedVector<float> rate(cloud.lists.pairs());
  chosen_kernels<D>().pair_rates(cloud.rows, cloud.offset.data(), cloud.velocity.data()->data(),
                                 gradient.data()->data(), nullptr, rate.data(), 0, cloud.size());
  const double expected_rate = (field + field.transpose()).norm() / std::sqrt(2.0);
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    if (j > i) {
      EXPECT_NEAR(rate[e], expected_rate, 1e-4 * expected_rate);
    }
    EXPECT_EQ(cloud.lists.neighbour(cloud.lists.mirror(e)), i);
  });
  // The elastic strain is added to the rate, also along the pair.
  const AlignedVector<Matrix> elastic(150, Matrix(2 * (field + field.transpose())));
  chosen_kernels<D>().pair_rates(cloud.rows, cloud.offset.data(), cloud.velocity.data()->data(),
                                 gradient.data()->data(), elastic.data()->data(), rate.data(), 0,
                                 cloud.size());
  cloud.for_each_pair([&](std::size_t i, std::size_t j, std::size_t e) {
    if (j > i) {
      EXPECT_NEAR(rate[e], 5 * expected_rate, 1e-3 * expected_rate);
    }
  });
}

/// Compares the forces of the symmetric stress with plain sums.
template <int D>
void expect_plain_stresses() {
  using Matrix = Eigen::Matrix<double, D, D>;
  const Cloud<D> cloud(200);
  const std::size_t n = cloud.position.size();
  AlignedVector<Matrix> block(n, Matrix::Identity()), tensor(n);
  AlignedVector<std::array<double, D*(D - 1) / 2>> turn(n), torque(n), sum(n);
  AlignedVector<float> lever(D * cloud.lists.pairs()), far_lever(D * cloud.lists.pairs());
  AlignedVector<VecD<D>> lever_sum(n);
  for (std::size_t k = 0; k < lever.size(); ++k) {
    lever[k] = float(std::cos(double(3 * k)));
    far_lever[k] = float(std::sin(double(2 * k)));
  }
  const auto at = [](const AlignedVector<float>& pairs, std::uint32_t e) {
    VecD<D> v;
    for (int d = 0; d < D; ++d) v[d] = double(pairs[e * D + std::uint32_t(d)]);
    return v;
  };
  const auto antisymmetric = [](const std::array<double, D*(D - 1) / 2>& components) {
    Matrix m = Matrix::Zero();
    std::size_t k = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a + 1; b < D; ++b, ++k) {
        m(a, b) = components[k];
        m(b, a) = -components[k];
      }
    return m;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < turn[i].size(); ++k) turn[i][k] = std::sin(double(i + k));
    tensor[i] = std::cos(double(i)) * Matrix::Identity() + antisymmetric(turn[i]);
    lever_sum[i].setConstant(std::sin(double(5 * i)));
  }
  block[1].setZero();
  AlignedVector<VecD<D>> q(n);
  const double* const blocks = block.data()->data();
  const double* const velocity = cloud.velocity.data()->data();
  const Kernels<D>& kernels = chosen_kernels<D>();
  kernels.sum_turns(cloud.rows, lever.data(), velocity, sum.data()->data(), 0, cloud.size());
  kernels.sum_stresses(cloud.rows, cloud.offset.data(), cloud.weight.data(), blocks, velocity,
                       turn.data()->data(), q.data()->data(), torque.data()->data(), 0,
                       cloud.size());
  kernels.spread_torques(cloud.rows, far_lever.data(), lever_sum.data()->data(), blocks,
                         torque.data()->data(), q.data()->data(), 0, cloud.size());
  AlignedVector<VecD<D>> minus(n);
  AlignedVector<std::array<double, D*(D - 1) / 2>> tensor_torque(n);
  kernels.sum_tensors(cloud.rows, cloud.offset.data(), cloud.slope.data(), blocks,
                      tensor.data()->data(), minus.data()->data(), tensor_torque.data()->data(), 0,
                      cloud.size());
  for (std::size_t i = 0; i < n; ++i) {
    VecD<D> force = VecD<D>::Zero(), tensor_force = VecD<D>::Zero();
    Matrix moment = Matrix::Zero(), turns = Matrix::Zero(), tensor_moment = Matrix::Zero();
    for (std::uint32_t e = cloud.lists.begin(i); e < cloud.lists.end(i); ++e) {
      const std::size_t j = cloud.lists.neighbour(e);
      const VecD<D> r = cloud.lists.separation(e), change = cloud.velocity[j] - cloud.velocity[i];
      const VecD<D> turned = 0.5 * (antisymmetric(turn[i]) + antisymmetric(turn[j])) * r;
      const VecD<D> t = 2 * double(cloud.weight[e]) * (change - turned);
      const VecD<D> s = double(cloud.slope[e]) * (tensor[i] + tensor[j]) * r;
      force += t + 2 * antisymmetric(torque[j]) * at(far_lever, e);
      tensor_force += s;
      moment -= 0.25 * (t * r.transpose() - r * t.transpose());
      tensor_moment -= 0.25 * (s * r.transpose() - r * s.transpose());
      turns += change * at(lever, e).transpose() - at(lever, e) * change.transpose();
    }
    force += 2 * antisymmetric(torque[i]) * lever_sum[i];
    const double moves = i == 1 ? 0 : 1;
    EXPECT_LT((q[i] - moves * (cloud.velocity[i] - force)).norm(), 1e-9 * (1 + force.norm())) << i;
    EXPECT_LT((minus[i] + moves * tensor_force).norm(), 1e-9 * (1 + tensor_force.norm())) << i;
    EXPECT_LT((antisymmetric(torque[i]) - moment).norm(), 1e-9 * (1 + moment.norm())) << i;
    EXPECT_LT((antisymmetric(tensor_torque[i]) - tensor_moment).norm(),
              1e-9 * (1 + tensor_moment.norm()))
        << i;
    EXPECT_LT((antisymmetric(sum[i]) - turns).norm(), 1e-9 * (1 + turns.norm())) << i;
  }
}

TEST(MpsKernels, StressesArePlainSums) {
  expect_plain_stresses<2>();
  expect_plain_stresses<3>();
}

}  // namespace
}  // namespace snowshed::methods::mps
