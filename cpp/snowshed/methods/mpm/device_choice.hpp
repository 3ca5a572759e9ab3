// The choice between processor and graphics card for a simulation.
#pragma once

#include "snowshed/methods/device_choice.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {

/// Returns the device that the settings ask for, opened. Nothing of a card is touched if they ask
/// for the processor. If they ask for a card, throws InputError if the machine has none, if a card
/// cannot compute the simulation, or if it has too little memory for `particles`. An automatic
/// choice is the processor in these cases, with the reason as a note.
DeviceChoice choose_device(const Options&, double particles);

/// Throws snowshed::gpu::Unavailable, which names both numbers, if a card has too little memory
/// left.
void require_memory(const snowshed::gpu::Device& card, const Options&, double particles);

}  // namespace snowshed::methods::mpm
