// A file as a checkpoint: refused, or a simulation that can be looked at, saved and taken on, into
// the next event too, unless its snow is in a state that cannot go on.
#include "fuzzing.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed {
namespace {

/// Scenes of more particles are sound too, but take longer than a mutation is worth.
constexpr double enough_particles = 2000;

void go_on(Simulation& simulation) {
  const bool more = simulation.event() < simulation.scene().events.count;
  if (!simulation.event_running() && more && simulation.cost().total_particles < enough_particles)
    simulation.begin_event();
  if (simulation.event_running()) simulation.step(3);
}

void use(Simulation& simulation, const std::filesystem::path& copy) {
  simulation.solver().state();
  simulation.solver().energy();
  simulation.save(copy);
  try {
    go_on(simulation);
  } catch (const SimulationError&) {
  }
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".bin");
  allow_refusal([&] { use(*Simulation::load(file.path()), file.path()); });
  return 0;
}
