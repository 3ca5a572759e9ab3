// Everything that the choice of a device must know about the solver for graphics cards.
#pragma once

#include <string>
#include <vector>

#include "snowshed/gpu/kernel_program.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {

/// A setting that a graphics card does not support, with its place in the scene and what to do.
struct Unsupported {
  std::string path, reason;
};

/// Returns everything that steps on a graphics card do not support; empty: all is supported.
std::vector<Unsupported> unsupported_on_gpu(const Options&);

/// Throws InputError, at the first of them with a text on all, if there are any.
void require_supported_on_gpu(const Options&);

/// Memory of a card that this many particles need with their grid, bytes. `energy`: whether the
/// balance of energy is kept.
double bytes_on_gpu(const Settings&, bool energy, double particles);

/// The kernels of a simulation, with the balance of energy or without it.
snowshed::gpu::KernelProgram gpu_kernels(bool energy);

}  // namespace snowshed::methods::mpm
