#include "snowshed/methods/slide/late_release.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::slide {
namespace {

constexpr double slope = 35;  // degrees

/// The mass of half a metre of snow over a rectangle on the slope, kg.
double slab_mass(double length, double width, double thickness = 0.5) {
  return 300 * thickness * length * width / std::cos(radians(slope));
}

Options slide_above(Area secondary) {
  Options o = slide_on(inclined(slope, 100, 40), rectangle(20.3, 18.3, 40.3, 50.3));
  o.areas.secondary_release = {std::move(secondary)};
  return o;
}

bool snow_within(const Method& slide, double west, double south, double east, double north) {
  for (const Vec3& x : slide.state().positions)
    if (x.x() >= west && x.x() <= east && x.y() >= south && x.y() <= north) return true;
  return false;
}

TEST(SlideSecondaryRelease, StartsAtTheEndOfTheStepInWhichSnowEnters) {
  const auto slide = released_slide(slide_above(rectangle(52.3, 20.3, 72.3, 44.3)));
  double entered = -1;
  while (entered < 0 && slide->time() < 20) {
    EXPECT_EQ(slide->mass_balance().secondary, 0);
    slide->step();
    if (snow_within(*slide, 52.3, 20.3, 72.3, 44.3)) entered = slide->time();
  }
  ASSERT_GT(entered, 0.5);
  EXPECT_EQ(slide->mass_balance().secondary, 0);
  const std::int64_t bonds = slide->bonds_made();
  slide->step();
  EXPECT_EQ(slide->late_releases()[0].time, entered);
  EXPECT_NEAR(slide->mass_balance().secondary / slab_mass(20, 24), 1, 1e-12);
  EXPECT_NEAR(total_mass(*slide) / slab_mass(20, 32 + 24), 1, 1e-12);
  EXPECT_GT(slide->bonds_made(), bonds);  // it is a slab of its own
  const double mass = slide->mass_balance().secondary;
  step(*slide, 50);
  EXPECT_EQ(slide->mass_balance().secondary, mass);  // once only
}

TEST(SlideSecondaryRelease, NeverStartsWithoutContact) {
  const auto slide = released_slide(slide_above(rectangle(52.3, 64.3, 72.3, 74.3)));
  while (!*slide->at_rest() && slide->time() < 30) slide->step();
  EXPECT_EQ(slide->late_releases()[0].time, waiting);
  EXPECT_EQ(slide->mass_balance().secondary, 0);
}

TEST(SlideSecondaryRelease, IsRefusedWhereSnowIsReleasedAlready) {
  EXPECT_THROW(make_solver(slide_above(rectangle(38.3, 20.3, 72.3, 44.3))), InputError);
  Options beyond = slide_above(rectangle(150.3, 20.3, 250.3, 44.3));
  EXPECT_THROW(make_solver(beyond), InputError);
}

TEST(SlideSecondaryRelease, FollowsTheFieldsInTheCompatibleMode) {
  Options o = slide_above(rectangle(52.3, 20.3, 72.3, 44.3));
  o.settings.mode = Mode::compatible;
  const auto slide = released_slide(o);
  const auto touches = [&] {
    // AvaFrame's raster of the area reaches half of sqrt(2) cells beyond its outline.
    const std::vector<double> flow = slide->flow().thickness_everywhere(slide->terrain());
    for (int row = 0; row < slide->terrain().rows(); ++row)
      for (int column = 0; column < slide->terrain().columns(); ++column) {
        const double x = 2.0 * column, y = 2.0 * row, reach = std::sqrt(2.0);
        if (x > 52.3 - reach && x < 72.3 + reach && y > 20.3 - reach && y < 44.3 + reach &&
            flow[slide->terrain().index(column, row)] > 0)
          return true;
      }
    return false;
  };
  while (!touches() && slide->time() < 20) slide->step();
  ASSERT_GT(slide->time(), 0.2);
  EXPECT_EQ(slide->mass_balance().secondary, 0);
  const std::size_t before = slide->size();
  slide->step();
  EXPECT_GT(slide->mass_balance().secondary, 0.9 * slab_mass(20, 24));
  const ParticleState s = slide->state();
  for (std::size_t i = before; i < s.ids.size(); ++i)
    EXPECT_TRUE(s.velocities[i].isZero(0.0));  // it moves from the next step on
  EXPECT_GT(s.ids.size(), before);
}

Options inflow_on_slope(std::vector<Pulse> pulses) {
  Options o = slide_on(inclined(slope, 100, 40), rectangle(20.3, 18.3, 30.3, 30.3));
  o.areas.inflows = {{rectangle(60.3, 40.3, 72.3, 52.3), false, std::move(pulses)}};
  return o;
}

TEST(SlideInflow, BringsTheIntegralOfTheHydrograph) {
  const auto slide =
      released_slide(inflow_on_slope({{0.5, 0.4, 8}, {0.123, 0.3, 0}, {1.0, 0.7, 12}}));
  const double area = slab_mass(12, 12, 1);  // kg per metre of thickness
  const double released = slide->mass_balance().released;
  double expected = 0;
  while (slide->time() < 1.2) {
    slide->step();
    expected = 0;
    // A step that begins at or after the time of a pulse has its snow.
    const double begin = slide->time() - slide->time_step() + 1e-6;
    for (const Pulse& p : {Pulse{0.5, 0.4, 8}, Pulse{0.123, 0.3, 0}, Pulse{1.0, 0.7, 12}})
      if (begin >= p.time) expected += p.thickness * area;
    ASSERT_NEAR(slide->mass_balance().inflow, expected, 1e-9 * area) << slide->time();
  }
  EXPECT_NEAR(expected / (1.4 * area), 1, 1e-12);
  EXPECT_NEAR(total_mass(*slide) / (released + expected), 1, 1e-12);
}

TEST(SlideInflow, EntersWithItsSpeedDownTheSlope) {
  Options o = inflow_on_slope({{0.1, 0.4, 15}});
  o.settings.friction = 0;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.mixing_rate = 0;
  o.areas.release_speed = 4;
  const auto slide = released_slide(o);
  const Vec3 down(std::cos(radians(slope)), 0, -std::sin(radians(slope)));
  for (const Vec3& u : slide->state().velocities) EXPECT_LT((u - 4 * down).norm(), 1e-12);
  const std::size_t before = slide->size();
  step(*slide, 11);
  const ParticleState s = slide->state();
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = before; i < s.ids.size(); ++i)
    mean += s.velocities[i] / double(s.ids.size() - before);
  EXPECT_NEAR(mean.norm() - 9.81 * std::sin(radians(slope)) * 0.01, 15, 1e-3);
  EXPECT_LT(mean.cross(down).norm(), 1e-2);
}

TEST(SlideInflow, IsAwaitedByASlideWithoutSnow) {
  Options o = slide_on(inclined(45, 30, 30), rectangle(40.3, 18.3, 54.3, 30.3));
  o.areas.inflows = {{rectangle(10.3, 20.3, 20.3, 30.3), true, {{12.0, 0.5, 3}}}};
  const auto slide = released_slide(o);
  bool was_empty = false;
  while (slide->time() < 11.9) {
    slide->step();
    was_empty = was_empty || slide->size() == 0;
    ASSERT_FALSE(*slide->at_rest());
  }
  EXPECT_TRUE(was_empty);
  while (slide->time() < 12.1) slide->step();
  EXPECT_GT(slide->size(), 0u);
  EXPECT_GT(slide->bonds().size(), 0u);
  EXPECT_NEAR(slide->late_releases()[0].time, 12.0, 1e-6);
}

TEST(SlideInflow, NeedsTimesOfStepsAndAnEmptyAreaInTheCompatibleMode) {
  Options o = inflow_on_slope({{0.125, 0.4, 8}});
  o.settings.mode = Mode::compatible;
  EXPECT_THROW(make_solver(o), InputError);
  o.areas.inflows[0].pulses = {{0.12, 0.4, 0}, {0.15, 0.4, 0}};
  const auto slide = released_slide(o);
  step(*slide, 14);
  EXPECT_GT(slide->mass_balance().inflow, 0);
  EXPECT_NEAR(slide->late_releases()[0].time, 0.11, 1e-9);  // at the start of the step to 0.12 s
  const ParticleState before = slide->state();
  EXPECT_THROW(slide->step(), SimulationError);  // the first snow has not left the area
  EXPECT_EQ(slide->state().positions, before.positions);
}

TEST(SlideInflow, OnLevelGroundHasNoDirection) {
  Options o = slide_on(geometry::terrain_of(60, 60, 2, [](double, double) { return 0.0; }),
                       rectangle(20.3, 20.3, 40.3, 40.3));
  o.areas.inflows = {{rectangle(60.3, 40.3, 72.3, 52.3), false, {{1, 0.5, 5}}}};
  EXPECT_THROW(make_solver(o), InputError);
  o.areas.inflows[0].pulses[0].speed = 0;
  EXPECT_NO_THROW(make_solver(o));
}

Options all_late(Mode mode) {
  Options o = slide_above(rectangle(44.3, 20.3, 64.3, 44.3));
  o.areas.inflows = {{rectangle(20.3, 60.3, 24.3, 70.3), false, {{0.3, 0.4, 9}, {2.5, 0.4, 9}}}};
  o.settings.mode = mode;
  o.settings.turbulence = 5000;  // thin snow flows off, too
  return o;
}

TEST(SlideLateRelease, ThreadsDoNotChangeTheBits) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options o = all_late(mode);
    const auto single = released_slide(o);
    o.settings.threads = 3;
    const auto three = released_slide(o);
    step(*single, 300);
    step(*three, 300);
    EXPECT_GT(single->mass_balance().secondary, 0);
    EXPECT_EQ(single->state().positions, three->state().positions);
    EXPECT_EQ(single->peaks().speed, three->peaks().speed);
  }
}

class SlideLateCheckpoint : public io::TemporaryFolder {};

TEST_F(SlideLateCheckpoint, ResumesToTheSameBitsAtAnyStep) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    const Options o = all_late(mode);
    const auto whole_run = released_slide(o);
    auto resumed = released_slide(o);
    for (int i = 0; i < 280; ++i) {
      whole_run->step();
      resumed->step();
      if (i % 7 != 0 && (i < 100 || i > 180)) continue;
      io::BinaryWriter out;
      resumed->save(out);
      out.save(path("c.bin"), [](const std::filesystem::path&) {});
      resumed = make_solver(o);
      resumed->load(io::BinaryReader::load(path("c.bin")));
      ASSERT_EQ(whole_run->state().positions, resumed->state().positions) << i;
    }
    EXPECT_GT(resumed->mass_balance().secondary, 0);
    EXPECT_EQ(whole_run->mass_balance().inflow, resumed->mass_balance().inflow);
    EXPECT_EQ(whole_run->mass_balance().secondary, resumed->mass_balance().secondary);
    EXPECT_EQ(whole_run->late_releases()[0].time, resumed->late_releases()[0].time);
    EXPECT_EQ(whole_run->peaks().thickness, resumed->peaks().thickness);
  }
}

}  // namespace
}  // namespace snowshed::methods::slide
