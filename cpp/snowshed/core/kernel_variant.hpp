// Choice of the instruction set whose kernels a process uses.
#pragma once

#include "snowshed/core/instruction_sets.hpp"

namespace snowshed {

/// Returns the widest variant that both the build and the machine have, or the one that the
/// environment variable SNOWSHED_KERNELS names. Throws InputError if that is not available.
KernelVariant kernel_variant();

/// Returns the name of `kernel_variant()`.
const char* kernel_variant_name();

/// Returns a sentence on the cost of kernels that are narrower than possible, because of the build
/// or of the processor; empty if they are not. (benchmarks/results has the times of all kernels.)
const char* slow_kernels_note();

}  // namespace snowshed
