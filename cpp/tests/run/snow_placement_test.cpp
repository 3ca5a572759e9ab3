#include "snowshed/run/snow_placement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/run/event_sequence.hpp"
#include "snowshed/run/external_record.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

/// A scene of one or more bodies, with further parts in JSON.
scene::Scene with_bodies(int dimension, const std::string& method, const std::string& bodies,
                         const std::string& parts = R"("ground": {})") {
  const std::string size = method == "mps" ? "spacing" : "dx";
  return scene::parse_scene(R"({"snowshed": 2, "dimension": )" + std::to_string(dimension) +
                            R"(, "method": ")" + method + R"(", "numerics": {")" + size +
                            "\": " + (dimension == 2 ? "0.02" : "0.04") +
                            R"(, "threads": 1}, "bodies": [)" + bodies + "], " + parts + "}");
}

/// A box in the plane (x, z), or in space with the same extent along y as along x.
std::string box(int dimension, double x, double z, double length, double height,
                const std::string& more = "") {
  const auto n = [](double value) { return std::to_string(value); };
  const bool flat = dimension == 2;
  return R"({"shape": {"type": "box", "center": [)" + n(x) + ", " + (flat ? "" : "0, ") + n(z) +
         R"(], "size": [)" + n(length) + ", " + (flat ? "" : n(length) + ", ") + n(height) + "]}" +
         more + "}";
}

/// The notes on the first event, or the message with which it is refused.
std::string notes_or_refusal(const scene::Scene& scene) try {
  Simulation sim(scene);
  sim.begin_event();
  std::string all;
  for (const std::string& note : sim.notes()) all += note + "\n";
  return all;
} catch (const InputError& error) {
  return std::string("refused: ") + error.what();
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

class SnowPlacement : public ::testing::TestWithParam<std::pair<int, const char*>> {
 protected:
  int dimension() const { return GetParam().first; }
  std::string method() const { return GetParam().second; }
  std::string box(double x, double z, double length, double height,
                  const std::string& more = "") const {
    return snowshed::run::box(dimension(), x, z, length, height, more);
  }
  std::string notes_or_refusal(const std::string& bodies,
                               const std::string& parts = R"("ground": {})") const {
    return snowshed::run::notes_or_refusal(with_bodies(dimension(), method(), bodies, parts));
  }
};

TEST_P(SnowPlacement, SnowMayTouchGroundWallsAndOtherSnow) {
  const bool flat = dimension() == 2;
  const std::string wall =
      std::string(R"("obstacles": [{"shape": {"type": "box", "center": [0.3, )") +
      (flat ? "0.1" : "0, 0.1") + R"(], "size": [0.2, )" + (flat ? "0.2" : "1, 0.2") + "]}}]";
  EXPECT_EQ(notes_or_refusal(box(0, 0.1, 0.4, 0.2) + "," + box(0, 0.25, 0.4, 0.1),
                             R"("ground": {}, )" + wall),
            "");
}

TEST_P(SnowPlacement, RefusesSnowBelowTheGround) {
  const std::string text = notes_or_refusal(box(0, 0, 0.4, 0.24));
  expect_part(text, "refused: /bodies/0/shape: 5");
  expect_part(text, "% of its particles lie below the ground, such as at (");
}

TEST_P(SnowPlacement, NamesTheObstacleThatContainsSnow) {
  const std::string parts =
      std::string(R"("ground": {}, "obstacles": [{"name": "post", "shape": )") +
      (dimension() == 2 ? R"({"type": "box", "center": [0, 0.2], "size": [0.1, 0.4]}}])"
                        : R"({"type": "box", "center": [0, 0, 0.2], "size": [0.1, 1, 0.4]}}])");
  expect_part(notes_or_refusal(box(0, 0.2, 0.4, 0.4), parts), "inside the obstacle \"post\"");
}

TEST_P(SnowPlacement, RefusesOverlappingBodies) {
  const std::string text = notes_or_refusal(box(0, 0.1, 0.4, 0.2) + "," + box(0.1, 0.1, 0.4, 0.2));
  expect_part(text, "refused: /bodies/0/shape: 7");
  expect_part(text, "within the snow of /bodies/1");
  // A small body lies completely within a large one, of which it takes up little.
  expect_part(notes_or_refusal(box(0, 0.25, 0.5, 0.5) + "," + box(0, 0.25, 0.04, 0.04)),
              "/bodies/1/shape: 100 % of its particles lie within the snow of /bodies/0");
}

TEST_P(SnowPlacement, SnowMayTouchTheSidesOfTheDomain) {
  const std::string parts = dimension() == 2
                                ? R"("domain": {"min": [-0.2, 0], "max": [0.2, 1]})"
                                : R"("domain": {"min": [-0.2, -0.2, 0], "max": [0.2, 0.2, 1]})";
  EXPECT_EQ(notes_or_refusal(box(0, 0.1, 0.4, 0.2), parts), "");
}

TEST_P(SnowPlacement, RefusesAddedSnowOutsideTheDomain) {
  const std::string parts = dimension() == 2
                                ? R"("domain": {"min": [-1, 0], "max": [1, 1]})"
                                : R"("domain": {"min": [-1, -1, 0], "max": [1, 1, 1]})";
  Simulation sim(with_bodies(dimension(), method(), box(0, 0.1, 0.4, 0.2), parts));
  sim.begin_event();
  methods::ParticleBatch corner;
  corner.positions = {{1.1, 0, -0.1}};
  corner.mass = sim.method().state().masses.front();
  try {
    sim.add_snow(corner);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    expect_part(error.what(), "positions: 100 % of its particles lie outside the domain");
  }
}

TEST_P(SnowPlacement, NotesSmallAndAllowedOverlaps) {
  const std::string sliver = notes_or_refusal(box(0, 0.1994, 0.4, 0.4));  // 0.15 % of its height
  EXPECT_EQ(sliver.find("refused"), std::string::npos) << sliver;
  const std::string half =
      notes_or_refusal(box(0, 0, 0.4, 0.24), R"("ground": {}, "misplaced_snow": "allow")");
  EXPECT_EQ(half.find("/bodies/0/shape: 5"), 0u) << half;
}

INSTANTIATE_TEST_SUITE_P(Methods, SnowPlacement,
                         ::testing::Values(std::pair{2, "mpm"}, std::pair{3, "mpm"},
                                           std::pair{2, "mps"}, std::pair{3, "mps"}));

TEST(SnowPlacementNotes, MentionSmallOverlaps) {
  const std::string text = notes_or_refusal(with_bodies(2, "mpm", box(2, 0, 0.199, 0.4, 0.4)));
  expect_part(text, "/bodies/0/shape: 0.");
  expect_part(text, "below the ground");
}

TEST(SnowPlacementNotes, UseTheCurrentPositionsOfObstacles) {
  // The obstacle has left the position of the second body before the second event begins.
  const std::string moving =
      R"("ground": {}, "events": {"count": 2, "max_time": 0.2, "rest_time": 0.01}, "obstacles":
      [{"shape": {"type": "box", "center": [2, 0.1], "size": [0.2, 0.2]},
        "motion": {"velocity": [50, 0]}}])";
  const std::string late = R"(, "event": 2)";
  scene::Scene scene = with_bodies(
      2, "mpm", box(2, 0, 0.1, 0.2, 0.2) + "," + box(2, 2, 0.1, 0.2, 0.2, late), moving);
  Simulation sim(scene);
  sim.begin_event();
  sim.run(keep_running, never);
  sim.begin_event();
  EXPECT_TRUE(sim.notes().empty());
  scene.obstacles[0].motion->velocity.setZero();
  Simulation still(scene);
  still.begin_event();
  still.run(keep_running, never);
  const std::size_t particles = still.method().size();
  EXPECT_THROW(still.begin_event(), InputError);
  EXPECT_EQ(still.method().size(), particles);  // nothing was added
  EXPECT_EQ(still.event(), 1);
}

TEST(SnowPlacementNotes, IncludeTheSnowOfEarlierEvents) {
  const std::string twice = R"("ground": {}, "events": {"count": 2, "max_time": 0.1})";
  for (const int dimension : {2, 3}) {
    // At the same position, just above it, and half inside.
    for (const double height : {0.05, 0.16, 0.1}) {
      const scene::Scene scene =
          with_bodies(dimension, "mpm",
                      box(dimension, 0, 0.05, 0.3, 0.1) + "," +
                          box(dimension, 0, height, 0.3, 0.1, R"(, "event": 2)"),
                      twice);
      Simulation sim(scene);
      sim.begin_event();
      sim.run(keep_running, never);
      if (height > 0.15) {
        sim.begin_event();
        EXPECT_TRUE(sim.notes().empty()) << sim.notes().front();
      } else {
        EXPECT_THROW(sim.begin_event(), InputError) << dimension << " " << height;
      }
    }
  }
}

/// A panel to which snow sticks, so that each slab lies on the previous one.
scene::Scene sticky_panel(int events) {
  scene::Scene scene = small_scene();
  scene.panel->condition = methods::Condition::sticky;
  scene.panel->friction = scene::Panel{}.friction;  // any other is noted
  scene.events.count = events;
  scene.events.max_time = 0.02;
  scene.events.rest_time = 0.005;
  return scene;
}

TEST(SnowPlacementNotes, OmitSlabsThatLieOnTheLastOne) {
  Simulation sim(sticky_panel(3));
  for (int event = 0; event < 3; ++event) {
    sim.begin_event();
    sim.run(keep_running, never);
  }
  EXPECT_TRUE(sim.notes().empty()) << sim.notes().front();
}

TEST(SnowPlacementNotes, MentionASlabWithinTheStackIfAllowed) {
  scene::Scene scene = small_scene();
  scene.events.count = 2;
  scene.events.max_time = 0.02;
  scene.events.rest_time = 0.005;
  scene.panel->height = 0.4;
  Simulation sim(scene);
  sim.begin_event();
  sim.run(keep_running, never);
  // The stack has grown through the panel's lower end, though hardly any snow lies on the panel.
  const scene::PanelFrame panel = scene::panel_frame(scene::resolve(scene));
  methods::ParticleBatch stack = methods::mpm::filled_box(
      2, panel.lower_edge() + Vec3(-0.01, 0, -0.1), panel.lower_edge() + Vec3(0.15, 0, 0.1), 0.004);
  scene.misplaced_snow = scene::MisplacedSnow::allow;
  Simulation grown(scene);
  grown.begin_event();
  grown.run(keep_running, never);
  stack.mass = 210 * 0.004 * 0.004;
  grown.add_snow(stack);
  const std::size_t before = grown.notes().size();
  grown.begin_event();
  EXPECT_EQ(grown.event(), 2);
  for (std::size_t i = before; i < grown.notes().size(); ++i)
    EXPECT_EQ(grown.notes()[i].find("/slab: in event 2, "), 0u) << grown.notes()[i];
}

TEST(SnowPlacementNotes, MentionThickenedObstacles) {
  const std::string parts =
      R"("ground": {}, "obstacles": [{"name": "shelf", "shape":
        {"type": "box", "center": [0, 0.5], "size": [1, 0.004]}}])";
  const std::string text =
      notes_or_refusal(with_bodies(2, "mpm", box(2, 0, 0.602, 0.4, 0.2), parts));
  expect_part(text, "beside the obstacle \"shelf\", where it is thickened");
  EXPECT_EQ(notes_or_refusal(with_bodies(2, "mps", box(2, 0, 0.602, 0.4, 0.2), parts)), "");
}

TEST(SnowPlacementNotes, ApplyToParticlesAddedByHand) {
  const scene::Scene scene = with_bodies(2, "mpm", box(2, 0, 0.1, 0.4, 0.2));
  Simulation sim(scene);
  sim.begin_event();
  methods::ParticleBatch above, within, below;
  above.positions = {{0, 0, 0.5}};
  within.positions = {{0, 0, 0.1}};
  below.positions = {{1, 0, -0.1}};
  above.mass = within.mass = below.mass = 0.01;
  sim.add_snow(above);
  EXPECT_THROW(sim.add_snow(within), InputError);
  EXPECT_THROW(sim.add_snow(below), InputError);
}

TEST(Percent, HasTwoDigitsIfSmall) {
  EXPECT_EQ(percent(0.0042), "0.42 %");
  EXPECT_EQ(percent(0.5), "50 %");
  EXPECT_EQ(percent(1), "100 %");
}

// --- mass ---------------------------------------------------------------------------------------

struct SolidWithVolume {
  std::string shape;
  double volume;
};

/// Boxes, rotated boxes and balls, with their volumes in closed form.
std::vector<SolidWithVolume> solids(int dimension) {
  if (dimension == 2)
    return {{R"({"type": "box", "center": [0, 1], "size": [0.47, 0.113]})", 0.47 * 0.113},
            {R"({"type": "transform", "shapes": [{"type": "box", "size": [0.47, 0.053]}],
                "angle": 37, "translate": [0, 1]})",
             0.47 * 0.053},
            {R"({"type": "plate", "center": [0, 1], "normal": [-0.5, 1], "length": 0.31,
                "thickness": 0.09})",
             0.31 * 0.09},
            {R"({"type": "sphere", "center": [0, 1], "radius": 0.17})", pi * 0.17 * 0.17}};
  return {
      {R"({"type": "box", "center": [0, 0, 1], "size": [0.31, 0.17, 0.113]})", 0.31 * 0.17 * 0.113},
      {R"({"type": "transform", "shapes": [{"type": "box", "size": [0.31, 0.17, 0.053]}],
              "axis": [0, 1, 0], "angle": 37, "translate": [0, 0, 1]})",
       0.31 * 0.17 * 0.053},
      {R"({"type": "sphere", "center": [0, 0, 1], "radius": 0.17})",
       4.0 / 3.0 * pi * std::pow(0.17, 3)}};
}

TEST(BodyMass, IsDensityTimesVolumeAtAnyResolution) {
  for (const int dimension : {2, 3})
    for (const std::string method : {"mpm", "mps"})
      for (const SolidWithVolume& solid : solids(dimension))
        for (const double size : {0.013, 0.02, 0.03}) {
          scene::Scene scene = with_bodies(dimension, method, R"({"shape": )" + solid.shape + "}");
          double density = scene.snow.density;
          if (method == "mps") {
            methods::mps::Settings& s = scene.numerics.as<methods::mps::Settings>();
            s.spacing = size;
            density = s.density;
          } else {
            scene.numerics.as<methods::mpm::Settings>().dx = size;
          }
          Simulation sim(scene);
          sim.begin_event();
          const double mass = methods::mpm::total_mass(sim.method().state());
          const double error = solid.shape.find("sphere") == std::string::npos ? 1e-6 : 2e-3;
          EXPECT_NEAR(mass / (density * solid.volume), 1, error) << solid.shape << " " << size;
          if (method == "mps")
            EXPECT_EQ(double(sim.method().size()), sim.cost().particles.front()) << solid.shape;
        }
}

/// A slab on the panel, by the MPS method.
scene::Scene mps_slab(double thickness, double spacing) {
  scene::Scene scene = scene::parse_scene(
      R"({"snowshed": 2, "dimension": 2, "method": "mps", "ground": {}, "numerics": {"threads": 1},
          "panel": {"height": 0.5, "length": 1.0, "tilt": 45}, "slab": {"thickness": 0.05}})");
  scene.slab->thickness = thickness;
  scene.numerics.as<methods::mps::Settings>().spacing = spacing;
  return scene;
}

TEST(BodyMass, IsExactForMpsSlabs) {
  for (const double thickness : {0.009, 0.05, 0.051, 0.1})
    for (const double spacing : {0.01, 0.02, 0.03}) {
      Simulation sim(mps_slab(thickness, spacing));
      sim.begin_event();
      const double density = sim.scene().numerics.as<methods::mps::Settings>().density;
      EXPECT_NEAR(methods::mpm::total_mass(sim.method().state()), density * thickness, 1e-9);
      EXPECT_EQ(double(sim.method().size()), sim.cost().particles.front());
      EXPECT_NEAR(double(sim.method().size()), thickness / (spacing * spacing), 0.5 + 1e-9);
      EXPECT_EQ(sim.notes().empty(), thickness > spacing) << thickness << " " << spacing;
    }
}

TEST(BodyMass, IsNotedForBodiesThinnerThanASpacing) {
  Simulation sim(mps_slab(0.009, 0.02));
  sim.begin_event();
  ASSERT_EQ(sim.notes().size(), 1u);
  expect_part(sim.notes()[0],
              "/slab: is 9 mm thick, less than the spacing of 20 mm: it becomes 23");
}

TEST(BodyMass, IsExactForMpsLayers) {
  scene::Scene scene = mps_slab(0, 0.02);
  scene.slab->layers = {{0.03, {}, 0}, {0.025, {}, 0}};
  Simulation sim(scene);
  sim.begin_event();
  const double density = sim.scene().numerics.as<methods::mps::Settings>().density;
  EXPECT_NEAR(methods::mpm::total_mass(sim.method().state()), density * 0.055, 1e-9);
  EXPECT_TRUE(sim.notes().empty()) << sim.notes().front();
}

// --- notes of runs ------------------------------------------------------------------------------

class RunNotes : public io::TemporaryFolder {};

TEST_F(RunNotes, AreRecordedOnceAlsoAfterResuming) {
  struct NoteRecorder : EventObserver {
    void noted(const std::string& note) override { notes.push_back(note); }
    std::vector<std::string> notes;
  };
  scene::Scene scene = with_bodies(2, "mpm", box(2, 0, 0, 0.4, 0.2),
                                   R"("ground": {}, "misplaced_snow": "allow",
                               "events": {"max_time": 0.01, "rest_time": 0.001})");
  NoteRecorder recorder, resumed_recorder;
  EventSequence::create(scene, ".", path("run")).run(recorder, never);
  ASSERT_EQ(recorder.notes.size(), 1u);
  EXPECT_EQ(RunRecord::read(path("run") / "run.json", {}).notes, recorder.notes);
  EventSequence resumed = EventSequence::resume(scene, ".", path("run"));
  ExternalRecord(resumed).add_note(recorder.notes.front());
  resumed.run(resumed_recorder, never);
  EXPECT_EQ(RunRecord::read(path("run") / "run.json", {}).notes, recorder.notes);
}

}  // namespace
}  // namespace snowshed::run
