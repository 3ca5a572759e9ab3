// A fifth method, which the program knows only by its descriptor: the method is read from a scene,
// described in the schema, run, filmed, saved and resumed.
#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/block/method.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/registry.hpp"
#include "snowshed/run/cost_report.hpp"
#include "snowshed/run/event_sequence.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::block {
namespace {

class Block : public TemporaryFolder {
 protected:
  /// Half a second on a plane of 30 degrees.
  static Scene scene() {
    return parse_scene(R"({"snowshed": 2, "method": "block", "numerics": {"friction": 0.2},
      "events": {"max_time": 0.5}, "output": {"energy": true}})");
  }

 private:
  const Descriptor descriptor_;
  const RegisteredMethod registered_{descriptor_};
};

const auto to_the_end = [](const RunReport&) { return true; };

TEST_F(Block, SlidesAsGalileiSays) {
  Simulation sim(scene(), ".");
  sim.begin_event();
  EXPECT_EQ(sim.run(to_the_end, 10), RunEnd::time_limit);
  const double tilt = radians(30), a = 9.81 * (std::sin(tilt) - 0.2 * std::cos(tilt));
  EXPECT_NEAR(sim.method().state().positions[0].norm(), a * 0.5 * 0.5 / 2, 1e-12);
  EXPECT_NEAR(capability<KeepsEnergy>(sim.method())->energies().back().second, 0, 1e-12);
}

TEST_F(Block, RestsWhereFrictionHoldsIt) {
  Scene held = scene();
  held.numerics.as<Settings>().friction = 0.6;
  Simulation sim(held, ".");
  sim.begin_event();
  EXPECT_EQ(sim.run(to_the_end, 10), RunEnd::rest);
  EXPECT_EQ(sim.method().state().positions[0], Vec3(0, 0, 0));
}

TEST_F(Block, ResumesToTheSameBits) {
  Simulation whole(scene(), ".");
  whole.begin_event();
  whole.step(100);
  whole.save(path("checkpoint"));
  const auto resumed = Simulation::load(path("checkpoint"));
  for (Simulation* sim : {&whole, resumed.get()}) sim->run(to_the_end, 10);
  EXPECT_EQ(resumed->method().state().positions, whole.method().state().positions);
  EXPECT_EQ(resumed->method().state().velocities, whole.method().state().velocities);
  EXPECT_EQ(resumed->method().counters().steps, 500);
}

TEST_F(Block, RunsIntoAResultsFolder) {
  auto sequence = EventSequence::create(scene(), ".", path("results"));
  EventObserver nobody;
  EXPECT_TRUE(sequence.run(nobody, 10));
  for (const char* file : {"run.json", "film.bin", "particles/event_001.vtp"})
    EXPECT_TRUE(std::filesystem::exists(path("results") / file)) << file;
  sequence.close();
  EXPECT_EQ(EventSequence::resume(scene(), ".", path("results")).record().finished[0].energy.size(),
            4u);
}

TEST_F(Block, IsPartOfTheFormOfScenes) {
  EXPECT_NE(scene_schema().find("A rigid block on a plane"), std::string::npos);
  EXPECT_EQ(parse_scene(write_scene(scene())).numerics.as<Settings>().friction, 0.2);
  EXPECT_THROW(parse_scene(R"({"snowshed": 2, "method": "block", "numerics": {"tilt": 91}})"),
               InputError);
  EXPECT_THROW(parse_scene(R"({"snowshed": 2, "method": "block", "ground": {}})"), InputError);
  EXPECT_EQ(report_cost(scene()).used, std::vector<std::string>{"friction"});
}

TEST(UnknownMethod, IsNoPartOfTheForm) {
  EXPECT_EQ(scene_schema().find("A rigid block on a plane"), std::string::npos);
  EXPECT_THROW(parse_scene(R"({"snowshed": 2, "method": "block"})"), InputError);
}

}  // namespace
}  // namespace snowshed::block
