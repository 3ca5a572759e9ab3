// Fuzz target of checkpoints. A file must be refused, or give a simulation that can be inspected,
// saved and continued, also into the next event. A SimulationError is allowed, because the state in
// the file may be one from which no step is possible.
#include "fuzzing.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed {
namespace {

/// Scenes with more particles are valid, too, but take too long for one mutation.
constexpr double max_added_particles = 2000;

void continue_run(Simulation& simulation) {
  const bool more = simulation.event() < simulation.scene().events.count;
  if (!simulation.event_running() && more &&
      simulation.cost().total_particles < max_added_particles)
    simulation.begin_event();
  if (simulation.event_running()) simulation.step(3);
}

void exercise(Simulation& simulation, const std::filesystem::path& copy) {
  simulation.method().state();
  if (const auto* keeping = capability<KeepsEnergy>(simulation.method())) keeping->energies();
  simulation.save(copy);
  try {
    continue_run(simulation);
  } catch (const SimulationError&) {
  }
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".bin");
  allow_refusal([&] { exercise(*Simulation::load(file.path()), file.path()); });
  return 0;
}
