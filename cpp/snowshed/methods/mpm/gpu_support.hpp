// Everything that the choice of a device must know about the solver for graphics cards.
#pragma once

#include <memory>

#include "snowshed/gpu/kernel_program.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::gpu {
class Device;
}

namespace snowshed::methods::mpm {

/// Throws InputError, with all reasons, if a card cannot compute the simulation.
void require_supported_on_gpu(const Options&);

/// Memory of a card that this many particles need with their grid, bytes.
double bytes_on_gpu(double particles);

/// The kernels of a simulation.
gpu::KernelProgram gpu_kernels(const Options&);

/// Makes a solver on a card that was opened with its kernels. The settings must be supported.
std::unique_ptr<Solver> make_gpu_solver(Options, std::shared_ptr<gpu::Device>);

}  // namespace snowshed::methods::mpm
