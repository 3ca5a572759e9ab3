// The graphics card of this machine: whether one is there, and opening it.
#pragma once

#include <memory>
#include <string>

#include "snowshed/gpu/card_claim.hpp"
#include "snowshed/gpu/cuda_driver.hpp"
#include "snowshed/gpu/device.hpp"
#include "snowshed/gpu/kernel_program.hpp"
#include "snowshed/gpu/runtime_compiler.hpp"

namespace snowshed::gpu {

/// A card that can be opened, with its driver and a compiler for it.
struct Card {
  std::shared_ptr<const CudaDriver> driver;
  std::shared_ptr<const RuntimeCompiler> compiler;
  ClaimedCard claimed;
  cuda::DeviceNumber number;
  std::string name;
  int architecture;
};

/// The number of cards that this process may use; 0 without a driver.
int count_cards();

/// The card on which the fewest other runs compute. (The environment variable CUDA_VISIBLE_DEVICES
/// chooses and orders the cards that a process sees.) Nothing is opened or compiled. Throws
/// Unavailable if driver, card or compiler are missing.
Card find_card();
Card find_card(std::shared_ptr<const CudaDriver>);

/// Opens a card, on which the kernels of a program can then be launched. They are compiled if they
/// have not been before (machine_code.hpp). Throws Unavailable and SimulationError.
std::unique_ptr<Device> open_device(const Card&, const KernelProgram&);

}  // namespace snowshed::gpu
