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

namespace snowshed::methods::block {
namespace {

class Block : public io::TemporaryFolder {
 protected:
  /// Half a second on a plane of 30 degrees.
  static scene::Scene scene() {
    return scene::parse_scene(R"({"snowshed": 2, "method": "block", "numerics": {"friction": 0.2},
      "events": {"max_time": 0.5}, "output": {"energy": true}})");
  }

 private:
  const Descriptor descriptor_;
  const RegisteredMethod registered_{descriptor_};
};

const auto never_stop = [](const run::RunReport&) { return true; };

TEST_F(Block, SlidesWithConstantAcceleration) {
  run::Simulation sim(scene(), ".");
  sim.begin_event();
  EXPECT_EQ(sim.run(never_stop, 10), run::RunEnd::time_limit);
  const double tilt = radians(30), a = 9.81 * (std::sin(tilt) - 0.2 * std::cos(tilt));
  EXPECT_NEAR(sim.method().state().positions[0].norm(), a * 0.5 * 0.5 / 2, 1e-12);
  EXPECT_NEAR(capability<KeepsEnergy>(sim.method())->energies().back().second, 0, 1e-12);
}

TEST_F(Block, RestsIfFrictionHoldsIt) {
  scene::Scene held = scene();
  held.numerics.as<Settings>().friction = 0.6;
  run::Simulation sim(held, ".");
  sim.begin_event();
  EXPECT_EQ(sim.run(never_stop, 10), run::RunEnd::rest);
  EXPECT_EQ(sim.method().state().positions[0], Vec3(0, 0, 0));
}

TEST_F(Block, ResumesToTheSameBits) {
  run::Simulation reference(scene(), ".");
  reference.begin_event();
  reference.step(100);
  reference.save(path("checkpoint"));
  const auto resumed = run::Simulation::load(path("checkpoint"));
  for (run::Simulation* sim : {&reference, resumed.get()}) sim->run(never_stop, 10);
  EXPECT_EQ(resumed->method().state().positions, reference.method().state().positions);
  EXPECT_EQ(resumed->method().state().velocities, reference.method().state().velocities);
  EXPECT_EQ(resumed->method().counters().steps, 500);
}

TEST_F(Block, RunsIntoAResultsFolder) {
  auto sequence = run::EventSequence::create(scene(), ".", path("results"));
  run::EventObserver observer;
  EXPECT_TRUE(sequence.run(observer, 10));
  for (const char* file : {"run.json", "film.bin", "particles/event_001.vtp"})
    EXPECT_TRUE(std::filesystem::exists(path("results") / file)) << file;
  sequence.close();
  EXPECT_EQ(run::EventSequence::resume(scene(), ".", path("results"))
                .record()
                .finished_events[0]
                .energy.size(),
            4u);
}

TEST_F(Block, IsPartOfTheSceneSchema) {
  EXPECT_NE(scene::scene_schema().find("A rigid block on a plane"), std::string::npos);
  EXPECT_EQ(scene::parse_scene(scene::write_scene(scene())).numerics.as<Settings>().friction, 0.2);
  EXPECT_THROW(
      scene::parse_scene(R"({"snowshed": 2, "method": "block", "numerics": {"tilt": 91}})"),
      InputError);
  EXPECT_THROW(scene::parse_scene(R"({"snowshed": 2, "method": "block", "ground": {}})"),
               InputError);
  EXPECT_EQ(run::report_cost(scene()).used, std::vector<std::string>{"friction"});
}

TEST(UnregisteredBlock, IsNotInTheSceneSchema) {
  EXPECT_EQ(scene::scene_schema().find("A rigid block on a plane"), std::string::npos);
  EXPECT_THROW(scene::parse_scene(R"({"snowshed": 2, "method": "block"})"), InputError);
}

}  // namespace
}  // namespace snowshed::methods::block
