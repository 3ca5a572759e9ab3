#include "snowshed/methods/slide/changing_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "io/temporary_folder.hpp"
#include "methods/slide/slide_testing.hpp"

namespace snowshed::methods::slide {
namespace {

/// A slope of 35 degrees that runs out onto level ground.
geometry::HeightField slope_to_level() {
  const double slope = std::tan(radians(35));
  return geometry::terrain_of(80, 30, 2, [=](double x, double) {
    if (x > 70) return 0.0;
    if (x < 50) return slope * (60 - x);
    return slope * (70 - x) * (70 - x) / 40;
  });
}

/// A slide that erodes snow, passes forest and stops, with all changes of the ground.
Options with_all_changes(Mode mode) {
  Options o = slide_on(slope_to_level(), rectangle(10.3, 18.3, 34.3, 40.3));
  o.areas.entrainment = {rectangle(38, 10, 50, 48, 0.2)};
  o.areas.resistance = {rectangle(56, 10, 64, 48)};
  Settings& s = o.settings;
  s.mode = mode;
  s.explicit_friction = mode == Mode::compatible;
  s.resistance = 0.01;
  s.detrainment = 5;
  s.friction = 0.3;
  s.stop_ratio = 1e-4;
  s.bonds = mode == Mode::improved;
  s.ground_gains_stopped = s.ground_gains_detrained = s.ground_loses_entrained = true;
  s.ground_min_change = mode == Mode::compatible ? 0 : 0.05;
  s.ground_rest_time = mode == Mode::compatible ? 1 : 0.2;
  return o;
}

void run_to_the_end(Solver& slide, int max_steps = 6000) {
  for (int i = 0; i < max_steps && !*slide.at_rest() && slide.size() > 0; ++i) slide.step();
}

double joules_of(const Solver& slide, const std::string& name) {
  for (const auto& [key, joules] : capability<KeepsEnergy>(slide)->energies())
    if (key == name) return joules;
  return std::nan("");
}

/// The volume that the ground must gain by the masses of the balance, m3.
double volume_of_masses(const MassBalance& m, const Settings& s) {
  return (m.stopped + m.detrained) / s.density - m.entrained / s.entrained_density;
}

TEST(ChangingGround, TheGroundGainsTheVolumeOfTheSnow) {
  const Options o = with_all_changes(Mode::improved);
  const auto slide = released_slide(o);
  run_to_the_end(*slide);
  const MassBalance& m = slide->mass_balance();
  EXPECT_GT(m.stopped, 0.2 * m.released);
  EXPECT_GT(m.detrained, 0.01 * m.released);
  EXPECT_GT(m.entrained, 0.01 * m.released);
  const double gained = slide->ground()->volume(), released = m.released / o.settings.density;
  EXPECT_NEAR((gained - volume_of_masses(m, o.settings)) / released, 0, 1e-12);
  EXPECT_NEAR(
      (total_mass(*slide) + m.stopped + m.detrained + m.left_terrain - m.entrained) / m.released, 1,
      1e-12);
}

TEST(ChangingGround, ErosionLowersTheGroundByNoMoreThanTheErodibleSnow) {
  Options o = with_all_changes(Mode::improved);
  o.settings.ground_gains_stopped = o.settings.ground_gains_detrained = false;
  o.settings.erosion_energy = 100;
  const auto slide = released_slide(o);
  step(*slide, 600);
  double deepest = 0;
  for (const double rise : slide->ground()->change()) {
    EXPECT_LE(rise, 0);
    deepest = std::max(deepest, -rise);
  }
  EXPECT_GT(deepest, 0.1);
  // Thickness normal to the ground; each particle of a step sees the snow before the step.
  EXPECT_LT(deepest, 1.1 * 0.2 / std::cos(radians(35)));
}

TEST(ChangingGround, SnowRestsForTheGivenTimeBeforeItIsGround) {
  Options o = slide_on(geometry::terrain_of(40, 40, 2, [](double, double) { return 0.0; }),
                       rectangle(30.3, 30.3, 50.3, 50.3, 0.05));
  o.settings.bonds = false;
  o.settings.friction = 1;
  o.settings.ground_gains_stopped = true;
  o.settings.ground_rest_time = 0.5;
  o.settings.ground_min_change = 0.01;
  const auto slide = released_slide(o);
  step(*slide, 50);
  EXPECT_EQ(slide->mass_balance().stopped, 0);
  slide->step();
  EXPECT_GT(slide->mass_balance().stopped, 0.5 * slide->mass_balance().released);
  const std::vector<double> change = slide->ground()->change();
  EXPECT_NEAR(change[20 * 40 + 20], 0.05, 0.01);
  EXPECT_EQ(change[0], 0);
}

/// The ids of the particles that rest, and the bonds by the ids of their particles.
struct Resting {
  explicit Resting(const Solver& slide) {
    const ParticleState s = slide.state();
    for (std::size_t i = 0; i < s.ids.size(); ++i)
      if (s.velocities[i].norm() == 0) ids.insert(s.ids[i]);
    const particles::FieldView id = slide.field("id");
    for (std::size_t b = 0; b < slide.bonds().size(); ++b)
      bonds.push_back({*id.at<std::uint32_t>(slide.bonds().first[b]),
                       *id.at<std::uint32_t>(slide.bonds().second[b])});
  }

  std::set<std::uint32_t> ids;
  std::vector<std::array<std::uint32_t, 2>> bonds;
};

TEST(ChangingGround, SnowThatIsBondedToMovingSnowIsNoGround) {
  Options o = with_all_changes(Mode::improved);
  o.areas.resistance.clear();  // forest would remove particles, too
  o.settings.ground_gains_detrained = false;
  o.settings.max_strain = 10;  // no bond breaks
  o.settings.bond_modulus = 5000;
  o.settings.ground_rest_time = 0;
  const auto slide = released_slide(o);
  for (int i = 0; i < 3000 && !*slide->at_rest() && slide->size() > 0; ++i) {
    const Resting before(*slide);
    slide->step();
    const std::vector<std::uint32_t> now = slide->state().ids;
    const auto has_gone = [&](std::uint32_t id) {
      return !std::binary_search(now.begin(), now.end(), id);
    };
    for (const auto& [first, second] : before.bonds)
      if (has_gone(first) || has_gone(second)) {
        ASSERT_EQ(before.ids.count(first) + before.ids.count(second), 2u) << i;
      }
    const auto bonds = std::int64_t(slide->bonds().size());
    ASSERT_EQ(bonds + slide->bonds_in_ground(), slide->bonds_made()) << i;
  }
  EXPECT_GT(slide->bonds_in_ground(), 0);
}

TEST(ChangingGround, TheEnergyBalanceCloses) {
  Options o = with_all_changes(Mode::improved);
  o.energy = true;
  const auto slide = released_slide(o);
  const double before = joules_of(*slide, "potential_j");
  run_to_the_end(*slide);
  EXPECT_NE(joules_of(*slide, "ground_j"), 0);
  EXPECT_LT(std::abs(joules_of(*slide, "residual_j")),
            0.02 * (before - joules_of(*slide, "potential_j")));
}

TEST(ChangingGround, ThreadsDoNotChangeTheResult) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options o = with_all_changes(mode);
    o.settings.layer_thickness = 0.05;  // enough particles for several threads
    const auto one = released_slide(o);
    o.settings.threads = 4;
    const auto four = released_slide(o);
    for (Solver* slide : {one.get(), four.get()}) step(*slide, 900);
    EXPECT_EQ(one->state().positions, four->state().positions);
    EXPECT_EQ(one->ground()->change(), four->ground()->change());
    EXPECT_GT(one->mass_balance().entrained, 0);
  }
}

class ChangingGroundCheckpoint : public io::TemporaryFolder {};

TEST_F(ChangingGroundCheckpoint, AResumedSlideHasTheSameBits) {
  for (const Mode mode : {Mode::improved, Mode::compatible}) {
    Options o = with_all_changes(mode);
    o.energy = true;
    const auto slide = released_slide(o);
    for (int i = 0; i < 6000 && slide->mass_balance().stopped == 0; ++i) slide->step();
    step(*slide, 20);
    EXPECT_GT(slide->mass_balance().stopped, 0) << int(mode);
    ASSERT_GT(slide->size(), 0u);
    const auto resumed = resumed_slide(o, *slide, path("state"));
    for (Solver* each : {slide.get(), resumed.get()})
      for (int i = 0; i < 200 && each->size() > 0; ++i) each->step();
    EXPECT_EQ(resumed->state().positions, slide->state().positions);
    EXPECT_EQ(resumed->ground()->change(), slide->ground()->change());
    EXPECT_EQ(resumed->ground()->rise, slide->ground()->rise);
    EXPECT_EQ(resumed->ground()->stopped, slide->ground()->stopped);
    EXPECT_EQ(resumed->mass_balance().stopped, slide->mass_balance().stopped);
    EXPECT_EQ(resumed->bonds_in_ground(), slide->bonds_in_ground());
    EXPECT_EQ(joules_of(*resumed, "ground_j"), joules_of(*slide, "ground_j"));
  }
}

TEST(ChangingGround, ADepositFillsADam) {
  // The crown stays where it is. Snow of 5 m/s climbs 1.2 m, but not 1.5 m.
  const auto passed_with_snow_at = [](double west) {
    Options o = slide_on(geometry::terrain_of(60, 30, 2, [](double, double) { return 0.0; }),
                         rectangle(west, 10.3, west + 30, 48.3, 0.6));
    o.settings.bonds = false;
    o.settings.friction_law = FrictionLaw::coulomb;
    o.settings.friction = 1;
    o.settings.ground_gains_stopped = true;
    o.settings.ground_rest_time = 0.1;
    o.settings.ground_min_change = 0;
    o.areas.dams = {{"dam", {{80, 2, 1.5}, {80, 56, 1.5}}, 90, 0}};
    const auto slide = released_slide(o);
    for (int i = 0; i < 200 && slide->size() > 0; ++i) slide->step();
    EXPECT_GT(slide->mass_balance().stopped, 0.9 * slide->mass_balance().released);
    ParticleBatch snow;
    snow.positions = {Vec3(79.99, 29, 0)};
    snow.velocity = Vec3(5, 0, 0);
    snow.mass = 1;
    slide->add({snow});
    slide->step();
    return slide->dams()[0].passed;
  };
  EXPECT_EQ(passed_with_snow_at(10.3), 0);
  EXPECT_EQ(passed_with_snow_at(64.3), 1);
}

/// Compatible mode: one particle on level ground with this speed, which friction reduces by
/// 0.098 m/s in a step.
std::unique_ptr<Solver> braking_particle(double speed, double min_change) {
  Options o = slide_on(geometry::terrain_of(20, 20, 2, [](double, double) { return 0.0; }),
                       rectangle(30.3, 30.3, 34.3, 34.3));
  o.settings.mode = Mode::compatible;
  o.settings.explicit_friction = true;
  o.settings.bonds = false;
  o.settings.friction_law = FrictionLaw::coulomb;
  o.settings.friction = 1;
  o.settings.ground_gains_stopped = true;
  o.settings.ground_min_change = min_change;
  auto slide = make_solver(o);
  ParticleBatch snow;
  snow.positions = {Vec3(9, 8.5, 0)};
  snow.velocity = Vec3(speed, 0, 0);
  snow.mass = 300;
  slide->add({snow});
  return slide;
}

TEST(ChangingGround, AsInAvaFrameSnowIsGroundWhereItWasBeforeTheStepThatStopsIt) {
  const auto slide = braking_particle(0.15, 0);
  slide->step();
  ASSERT_EQ(slide->size(), 1u);
  const Vec3 before = slide->state().positions[0];
  slide->step();
  EXPECT_EQ(slide->size(), 0u);
  EXPECT_EQ(slide->mass_balance().stopped, 300);
  const double depth = 300 / (300 * 4.0), east = before.x() / 2 - 4, north = 0.25;
  const std::vector<double> change = slide->ground()->change();
  EXPECT_NEAR(change[4 * 20 + 4], depth * (1 - east) * (1 - north), 1e-12);
  EXPECT_NEAR(change[4 * 20 + 5], depth * east * (1 - north), 1e-12);
  EXPECT_NEAR(change[5 * 20 + 5], depth * east * north, 1e-12);
  EXPECT_NEAR(slide->ground()->volume(), 1, 1e-12);
}

TEST(ChangingGround, AsInAvaFrameSmallChangesAndThoseOfTheFirstStepAreLost) {
  const auto with_large_threshold = braking_particle(0.15, 0.1);  // the largest change is 0.094 m
  step(*with_large_threshold, 2);
  const auto stopped_in_the_first_step = braking_particle(0.05, 0);
  stopped_in_the_first_step->step();
  for (const Solver* slide : {with_large_threshold.get(), stopped_in_the_first_step.get()}) {
    EXPECT_EQ(slide->size(), 0u);
    EXPECT_EQ(slide->mass_balance().stopped, 300);
    EXPECT_EQ(slide->ground()->volume(), 0);
  }
}

TEST(ChangingGround, WithoutChangesThereIsNoGroundOfItsOwn) {
  const auto slide = released_slide(slide_on(inclined(36), rectangle(20.3, 18.3, 40.3, 40.3)));
  EXPECT_EQ(slide->ground(), nullptr);
}

}  // namespace
}  // namespace snowshed::methods::slide
