// Manipulated checkpoints, and checkpoints of runs on several threads.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed::run {
namespace {

/// A drop of snow above the ground.
scene::Scene drop(double dx) {
  scene::Scene scene;
  scene.dimension = 2;
  scene.ground.emplace();
  scene::BodySpec body;
  body.shape.type = "sphere";
  body.shape.radius = 0.05;
  body.shape.center = {0, 0, 0.06};
  scene.bodies.push_back(body);
  scene.numerics.as<methods::mpm::Settings>().dx = dx;
  scene.numerics.as<methods::mpm::Settings>().threads = 1;
  return scene;
}

class SimulationCheckpoint : public io::TemporaryFolder {};

/// With a clock of NaN an event would never end.
TEST_F(SimulationCheckpoint, NonFiniteNumbersAreRefused) {
  Simulation sim(drop(0.02));
  sim.begin_event();
  sim.save(path("good"));
  const std::string bytes = content(path("good"));
  for (const char* section : {"clock", "run", "energy"})
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      write_plainly(path("forged"), io::forged(bytes, io::data_of(bytes, section), value));
      const std::string message =
          io::message_of<InputError>([&] { Simulation::load(path("forged")); });
      EXPECT_NE(message.find(section + std::string("' is not a finite number")), std::string::npos)
          << message;
    }
}

/// Empty blocks could need far more memory than the file.
TEST_F(SimulationCheckpoint, EmptyBlocksAreRefused) {
  Simulation sim(drop(0.01));
  sim.begin_event();
  sim.save(path("good"));
  const std::string bytes = content(path("good"));
  const auto first = io::BinaryReader::load(path("good")).get<std::int32_t>("blocks/first");
  ASSERT_GT(first.size(), 2u);
  const std::string table(reinterpret_cast<const char*>(first.data()), 4 * first.size());
  // The second block begins where the first does, so the first has no particles.
  write_plainly(path("forged"), io::forged(bytes, bytes.find(table) + 4, std::int32_t{0}));
  EXPECT_THROW(Simulation::load(path("forged")), InputError);
}

/// The results then agree to rounding, and not to the same bits.
TEST_F(SimulationCheckpoint, ANoteSaysThatARunBeganOnAnotherDevice) {
  Simulation sim(drop(0.02));
  sim.begin_event();
  sim.save(path("of_cpu"));
  EXPECT_TRUE(Simulation::load(path("of_cpu"))->notes().empty());
  const std::string bytes = content(path("of_cpu"));
  write_plainly(path("of_gpu"), io::forged(bytes, io::data_of(bytes, "device"), 'g'));
  EXPECT_EQ(Simulation::load(path("of_gpu"))->notes(),
            std::vector<std::string>{
                "the checkpoint was made on a gpu, and the run continues on a cpu: to rounding, "
                "not to the same bits"});
}

/// There is enough snow for three threads.
TEST_F(SimulationCheckpoint, ThreadsDoNotChangeTheBytes) {
  scene::Scene scene = drop(0.003);
  scene.bodies.front().velocity = {0.5, 0, -3};
  scene.output.energy = true;
  std::string first;
  for (const int threads : {1, 2, 3}) {
    scene.numerics.as<methods::mpm::Settings>().threads = threads;
    Simulation sim(scene);
    sim.begin_event();
    ASSERT_GT(sim.method().size(), 4000u);
    EXPECT_EQ(sim.run([](const RunReport& r) { return r.steps < 200; }, 0.0), RunEnd::paused);
    sim.save(path("checkpoint"));
    std::string saved = content(path("checkpoint"));
    saved.erase(0, saved.find("base_dir"));  // the scene before it names the threads
    saved.resize(saved.size() - 8);          // the checksum
    if (threads == 1) first = saved;
    EXPECT_TRUE(saved == first) << threads;
  }
}

}  // namespace
}  // namespace snowshed::run
