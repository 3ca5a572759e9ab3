// The simulation that Python holds: shared with the sequence of events that runs it, if there is
// one, and guarded against use by two threads at once.
#pragma once

#include <memory>

#include "snowshed/run/simulation.hpp"
#include "use_guard.hpp"

namespace snowshed {

using SimulationHandle = Guarded<std::shared_ptr<run::Simulation>>;

}  // namespace snowshed
