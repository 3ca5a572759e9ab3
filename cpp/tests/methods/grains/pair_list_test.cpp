#include "snowshed/methods/grains/pair_list.hpp"

#include <gtest/gtest.h>

#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::methods::grains {
namespace {

/// A sample whose grains are scattered and turned, some beyond the box.
struct ScatteredGrains {
  explicit ScatteredGrains(bool periodic) : model(options(periodic)) {
    Random random(3);
    boundary = initial_boundary(model.loaded_sample());
    boundary.plate[1].z() -= 0.3 * model.box.z();
    for (const GrainConstants& grain : model.grains) {
      const auto between = [&](double low, double high) {
        return low + (high - low) * random.uniform();
      };
      const Vec3 axis = Vec3(between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
      GrainPose pose;
      for (int k = 0; k < 3; ++k) pose.position[k] = between(-0.5, 1.5) * model.box[k];
      pose.orientation =
          Orientation(Eigen::AngleAxisd(between(0, 3), axis)) * grain.initial_orientation;
      poses.push_back(pose);
    }
  }
  static Options options(bool periodic) {
    Options o = grains_of(random_snow(12, 4));
    if (periodic) o.settings.sides = Sides::periodic;
    return o;
  }
  PairSearch search(int threads = 1) const {
    return {model.spheres,    std::uint32_t(model.grains.size()),
            model.radius,     0.4 * model.radius,
            model.periodic(), model.cone,
            1000000,          threads};
  }
  /// Returns all near pairs of spheres, from a comparison of each sphere with all periodic images
  /// of the others.
  std::vector<PairKey> by_brute_force() const {
    std::vector<PairKey> pairs;
    std::vector<Vec3> x;
    const auto& spheres = model.spheres;
    for (std::size_t s = 0; s < spheres.offsets.size(); ++s)
      x.push_back(poses[spheres.grain[s]].position +
                  poses[spheres.grain[s]].orientation * spheres.offsets[s]);
    const int images = model.periodic() ? 3 : 0;
    for (std::uint32_t a = 0; a < x.size(); ++a)
      for (std::uint32_t b = 0; b < x.size(); ++b)
        for (int i = -images; i <= images; ++i)
          for (int j = -images; j <= images; ++j) {
            const std::uint32_t grain_a = spheres.grain[a], grain_b = spheres.grain[b];
            if (grain_a > grain_b || (grain_a == grain_b && (i < 0 || (i == 0 && j <= 0))))
              continue;
            const Vec3 shift(i * model.box.x(), j * model.box.y(), 0);
            if ((x[b] + shift - x[a]).norm() < 2.4 * model.radius)
              pairs.push_back({grain_a, grain_b, {i, j}, a, b});
          }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  Model model;
  std::vector<GrainPose> poses;
  Boundary boundary;
};

TEST(PairList, ListsAllNearSpheres) {
  for (const bool periodic : {false, true}) {
    const ScatteredGrains scattered(periodic);
    std::vector<PairKey> pairs =
        find_pairs(scattered.search(), scattered.poses, scattered.boundary);
    EXPECT_EQ(pairs, find_pairs(scattered.search(3), scattered.poses, scattered.boundary));
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](const PairKey& key) {
                                 return key.second >= scattered.model.grains.size();
                               }),
                pairs.end());
    EXPECT_GT(pairs.size(), 50u);
    EXPECT_TRUE(pairs == scattered.by_brute_force());
  }
}

TEST(PairList, ListsAllNearPlatesAndWalls) {
  const ScatteredGrains scattered(false);
  std::size_t expected = 0;
  const double r = scattered.model.radius;
  const auto& spheres = scattered.model.spheres;
  for (std::size_t s = 0; s < spheres.offsets.size(); ++s) {
    const GrainPose& pose = scattered.poses[spheres.grain[s]];
    const Vec3 x = pose.position + pose.orientation * spheres.offsets[s];
    for (int axis = 0; axis < 2; ++axis) {
      expected += x[axis] - r < 0.4 * r;
      expected += scattered.model.box[axis] - x[axis] - r < 0.4 * r;
    }
    for (const Vec3& plate : scattered.boundary.plate)
      for (int i = -20; i < 40; ++i)
        for (int j = -20; j < 40; ++j)
          expected += (plate + Vec3((2 * i + 1) * r, (2 * j + 1) * r, 0) - x).norm() < 2.4 * r;
  }
  const auto pairs = find_pairs(scattered.search(), scattered.poses, scattered.boundary);
  EXPECT_EQ(std::size_t(std::count_if(
                pairs.begin(), pairs.end(),
                [&](const PairKey& key) { return key.second >= scattered.model.grains.size(); })),
            expected);
}

TEST(PairList, KeepsHistoriesAndBonds) {
  const ScatteredGrains scattered(true);
  const auto pairs = find_pairs(scattered.search(), scattered.poses, scattered.boundary);
  std::vector<PairHistory> past;
  for (std::size_t i = 0; i < pairs.size(); i += 7)
    past.push_back({pairs[i], Vec3(double(i), 1, 2), i % 2 == 0, i % 2 == 0});
  // A bonded pair whose spheres have moved apart is kept.
  PairKey far{0, 1, {9, 9}, 0, scattered.model.grains[1].first_sphere};
  past.push_back({far, Vec3(5, 5, 5), true, true});
  std::sort(past.begin(), past.end(),
            [](const PairHistory& x, const PairHistory& y) { return x.key < y.key; });
  const PairList list = make_list(scattered.search(), pairs, past);
  EXPECT_EQ(list.size() % pairs_at_once, 0u);
  EXPECT_EQ(list.all().size(), pairs.size() + 1);
  const std::vector<PairHistory> histories = list.histories();
  ASSERT_EQ(histories.size(), past.size());
  for (std::size_t i = 0; i < histories.size(); ++i) {
    EXPECT_EQ(histories[i].key, past[i].key);
    EXPECT_EQ(histories[i].shear, past[i].shear);
    EXPECT_EQ(histories[i].bonded, past[i].bonded);
  }
  // A bond that breaks while its spheres are far apart leaves its pair in the list.
  PairList broken = list;
  std::fill(broken.bonded.begin(), broken.bonded.end(), std::uint8_t(0));
  EXPECT_EQ(make_list(scattered.search(), pairs, broken.all()).a, list.a);
  for (PairHistory& h : past) h.always_listed = h.bonded = false;
  EXPECT_EQ(make_list(scattered.search(), pairs, past).all().size(), pairs.size());
}

TEST(PairList, TooManyPairsAreAnError) {
  const ScatteredGrains scattered(false);
  PairSearch search = scattered.search();
  search.max_pairs = 10;
  EXPECT_THROW(find_pairs(search, scattered.poses, scattered.boundary), SimulationError);
}

TEST(PairList, PeriodsAsShortAsASphereAreAnError) {
  ScatteredGrains scattered(true);
  scattered.boundary.side[1] = 4 * scattered.model.radius;
  EXPECT_THROW(find_pairs(scattered.search(), scattered.poses, scattered.boundary),
               SimulationError);
}

}  // namespace
}  // namespace snowshed::methods::grains
