// Fuzz target of checkpoints. A file must be refused, or give a simulation that can be inspected,
// saved and continued, also into the next event. A SimulationError is allowed, because the state in
// the file may be one from which no step is possible.
#include "fuzzing.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed {
namespace {

/// Scenes with more particles are valid, but take too long for one mutation.
constexpr double max_added_particles = 2000;

void continue_run(run::Simulation& simulation) {
  const bool has_next_event = simulation.event() < simulation.scene().events.count;
  if (!simulation.event_running() && has_next_event &&
      simulation.cost().total_particles < max_added_particles)
    simulation.begin_event();
  if (simulation.event_running()) simulation.step(3);
}

void exercise(run::Simulation& simulation, const std::filesystem::path& copy) {
  simulation.method().state();
  if (const auto* keeping = methods::capability<methods::KeepsEnergy>(simulation.method()))
    keeping->energies();
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
  allow_refusal([&] { exercise(*run::Simulation::load(file.path()), file.path()); });
  return 0;
}
