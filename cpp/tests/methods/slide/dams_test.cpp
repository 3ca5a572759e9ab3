#include "snowshed/methods/slide/dams.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::slide {
namespace {

geometry::HeightField level() {
  return geometry::terrain_of(60, 60, 2, [](double, double) { return 0.0; });
}

/// Ground without friction and a dam; the steps are so short that weight hardly counts.
Options with_dam(geometry::HeightField terrain, std::vector<Dam::Corner> corners,
                 double restitution, Mode mode = Mode::improved, double slope = 90) {
  Options o = slide_on(std::move(terrain), rectangle(10.3, 10.3, 20.3, 20.3));
  o.settings.mode = mode;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.friction = 0;
  o.settings.mixing_rate = 0;
  o.settings.artificial_viscosity = 0;
  o.settings.bonds = false;
  o.settings.time_step = 1e-4;
  o.areas.dams = {{"dam", std::move(corners), slope, restitution}};
  return o;
}

/// A single light particle.
std::unique_ptr<Solver> particle(const Options& o, double x, double y, const Vec3& velocity) {
  auto slide = make_solver(o);
  ParticleBatch batch;
  batch.positions = {Vec3(x, y, 0)};
  batch.velocity = velocity;
  batch.mass = 1e-3;
  slide->add(batch);
  return slide;
}

Vec3 velocity(const Method& slide) { return slide.state().velocities[0]; }
Vec3 position(const Method& slide) { return slide.state().positions[0]; }

TEST(SlideDam, ThrowsSnowBackWithTheRestitutionAndKeepsTheSpeedAlongIt) {
  for (const double e : {0.0, 0.3, 1.0}) {
    const Options o = with_dam(level(), {{60, 20, 20}, {60, 100, 20}}, e);
    const auto slide = particle(o, 60 - 5e-4, 50, {10, 3, 0});
    slide->step();
    EXPECT_LT((velocity(*slide) - Vec3(-e * 10, 3, 0)).norm(), 1e-6) << e;
    // Half of the step leads to the dam, the other half away from it.
    EXPECT_NEAR(position(*slide).x(), 60 - e * 5e-4, 2e-7) << e;
    EXPECT_NEAR(position(*slide).y(), 50 + 3e-4, 2e-7) << e;
    EXPECT_EQ(slide->dams()[0].passed, 0);
  }
}

TEST(SlideDam, FollowsTheNormalAlongSlopingGround) {
  const geometry::HeightField plane = inclined(35, 60, 60);
  const Options o = with_dam(plane, {{40, 40, 900}, {80, 70, 900}}, 0.5);
  const Vec3 n(std::sin(radians(35)), 0, std::cos(radians(35)));
  Vec3 u(12, -4, 0);
  u.z() = -n.x() / n.z() * u.x();
  // The impulse of a vertical wall without friction is horizontal; the ground takes what presses
  // on it.
  const Vec3 wall = Vec3(30, -40, 0).normalized();
  const Vec3 along_ground = (wall - wall.dot(n) * n).normalized();
  const Vec3 expected = u - 1.5 * u.dot(along_ground) * along_ground;
  const auto slide = particle(o, 60 - 1e-4, 55 + 1e-4, u);
  slide->step();
  EXPECT_LT((velocity(*slide) - expected).norm(), 2e-3);
}

TEST(SlideDam, IsTheSameFromBothSidesRotatedAndMirrored) {
  const std::vector<Dam::Corner> line{{44, 40, 99}, {60, 52, 99}, {66, 78, 99}};
  const Vec3 from(50, 50, 0), u(30, 7, 0), middle(59, 59, 0);
  struct Turn {
    double xx, xy, yx, yy;
  };
  const auto moved = [&](const Turn& t, const Vec3& v) {
    return Vec3(t.xx * v.x() + t.xy * v.y(), t.yx * v.x() + t.yy * v.y(), 0);
  };
  const auto run = [&](const Turn& t, bool reversed) {
    std::vector<Dam::Corner> corners;
    for (const Dam::Corner& c : line) {
      const Vec3 p = middle + moved(t, Vec3(c.x, c.y, 0) - middle);
      corners.push_back({p.x(), p.y(), c.height});
    }
    if (reversed) std::reverse(corners.begin(), corners.end());
    Options o = with_dam(level(), corners, 0.7);
    o.settings.time_step = 0.05;
    const Vec3 start = middle + moved(t, from - middle);
    const auto slide = particle(o, start.x(), start.y(), moved(t, u));
    step(*slide, 12);
    return std::pair{Vec3(position(*slide) - middle), velocity(*slide)};
  };
  const auto [x, v] = run({1, 0, 0, 1}, false);
  EXPECT_LT(v.dot(u), 0);  // it was thrown back
  for (const Turn& t : {Turn{1, 0, 0, 1}, Turn{0, -1, 1, 0}, Turn{-1, 0, 0, 1}, Turn{0, 1, 1, 0}})
    for (const bool reversed : {false, true}) {
      const auto [turned_x, turned_v] = run(t, reversed);
      EXPECT_LT((turned_x - moved(t, x)).norm(), 1e-6);
      EXPECT_LT((turned_v - moved(t, v)).norm(), 1e-6);
    }
}

TEST(SlideDam, IsPassedWithTheEnergyThatClimbingItTakes) {
  const double speed = 10;  // enough for 5.1 m
  for (const double height : {1.0, 4.0, 5.0, 5.2, 20.0}) {
    const Options o = with_dam(level(), {{60, 20, height}, {60, 100, height}}, 0.0);
    const auto slide = particle(o, 60 - 5e-4, 50, {speed, 2, 0});
    slide->step();
    const double rest = speed * speed - 2 * 9.81 * height;
    EXPECT_NEAR(velocity(*slide).x(), rest > 0 ? std::sqrt(rest) : 0.0, 1e-3) << height;
    EXPECT_EQ(slide->dams()[0].passed, rest > 0 ? 1e-3 : 0.0) << height;
    EXPECT_EQ(position(*slide).x() > 60, rest > 0) << height;
  }
}

Options slide_against_dam(double height, Mode mode = Mode::improved) {
  Options o = slide_on(inclined(36, 100, 40), rectangle(20.3, 20.3, 50.3, 60.3));
  o.settings.mode = mode;
  o.energy = true;
  // From north to south, so that snow comes from the left.
  o.areas.dams = {{"dam",
                   {{60.4, 4.2, height}, {68.3, 40.1, height}, {61.7, 74.6, height}},
                   mode == Mode::compatible ? 60.0 : 90.0,
                   mode == Mode::compatible ? 1.0 : 0.0}};
  return o;
}

TEST(SlideDam, HoldsAllSnowThatCannotClimbIt) {
  for (const double step_length : {0.01, 0.1}) {
    Options o = slide_against_dam(100);
    o.settings.time_step = step_length;
    o.settings.bonds = false;
    const auto slide = released_slide(o);
    const double mass = total_mass(*slide);
    while (!*slide->at_rest() && slide->time() < 25) slide->step();
    EXPECT_EQ(slide->dams()[0].passed, 0);
    EXPECT_NEAR((total_mass(*slide) + slide->mass_balance().left_terrain) / mass, 1, 1e-12);
    std::size_t behind = 0;
    for (const Vec3& x : slide->state().positions)
      behind += x.x() > 68.5 && x.y() > 20 && x.y() < 60;
    EXPECT_LT(double(behind), 0.02 * double(slide->size()));  // around the ends only
  }
}

TEST(SlideDam, TakesEnergyAndTheBalanceCloses) {
  const auto slide = released_slide(slide_against_dam(0.6));
  const auto energy = [&](const std::string& name) {
    for (const auto& [key, joules] : capability<KeepsEnergy>(*slide)->energies())
      if (key == name) return joules;
    return std::nan("");
  };
  const double before = energy("potential_j");
  step(*slide, 700);
  EXPECT_GT(slide->dams()[0].passed, 0);
  EXPECT_GT(energy("dams_j"), 0);
  EXPECT_LT(std::abs(energy("residual_j")), 0.015 * (before - energy("potential_j")));
}

TEST(SlideDam, TurnsVelocitiesAboutItsInclinedFaceInTheCompatibleMode) {
  // From south to north the left is the west. A face of slope b turns a level velocity by 2 b.
  for (const double slope : {90.0, 75.0, 60.0}) {
    const double height = 30;
    const double foot = 60 - height / std::tan(radians(slope));
    const Options o =
        with_dam(level(), {{60, 20, height}, {60, 100, height}}, 1.0, Mode::compatible, slope);
    const auto slide = particle(o, foot - 5e-4, 50, {10, 3, 0});
    slide->step();
    const double b = radians(slope);
    EXPECT_NEAR(velocity(*slide).x(), 10 * std::cos(2 * b), 1e-3) << slope;
    EXPECT_NEAR(velocity(*slide).y(), 3, 1e-3) << slope;
    EXPECT_NEAR(std::abs(velocity(*slide).z()), 10 * std::sin(2 * b), 1e-3) << slope;
  }
}

TEST(SlideDam, BeyondTheTerrainIsRefused) {
  EXPECT_THROW(make_solver(with_dam(level(), {{60, 20, 5}, {600, 20, 5}}, 0)), InputError);
}

class SlideDamCheckpoint : public io::TemporaryFolder {};

TEST_F(SlideDamCheckpoint, ResumesToTheSameBitsOnAnyNumberOfThreads) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options o = slide_against_dam(0.6, mode);
    const auto slide = released_slide(o);
    step(*slide, 400);
    o.settings.threads = 3;
    const auto resumed = resumed_slide(o, *slide, path("c.bin"));
    step(*slide, 350);
    step(*resumed, 350);
    EXPECT_GT(slide->dams()[0].passed, 0);
    EXPECT_EQ(slide->state().positions, resumed->state().positions);
    EXPECT_EQ(slide->dams()[0].passed, resumed->dams()[0].passed);
    EXPECT_EQ(capability<KeepsEnergy>(*slide)->energies(),
              capability<KeepsEnergy>(*resumed)->energies());
  }
}

}  // namespace
}  // namespace snowshed::methods::slide
