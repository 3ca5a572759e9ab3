// The material point method on a graphics card, or on any other device that runs its kernels.
#pragma once

#include <memory>

#include "snowshed/gpu/device.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {

/// Returns a solver that takes its steps on a device. Everything else, such as edits, fields and
/// checkpoints, is the processor's, which fetches the particles when it needs them. Throws
/// InputError for what devices do not support (see `unsupported_on_gpu`).
std::unique_ptr<Solver> make_gpu_solver(Options, std::shared_ptr<snowshed::gpu::Device>);

}  // namespace snowshed::methods::mpm
