// Choice of the instruction set whose kernels a process uses.
#pragma once

#include "snowshed/core/instruction_sets.hpp"

namespace snowshed {

/// Returns the widest variant that both the build and the machine have, or the one that the
/// environment variable SNOWSHED_KERNELS names. Throws InputError if that is not available.
KernelVariant kernel_variant();

/// Returns the name of `kernel_variant()`.
const char* kernel_variant_name();

/// Returns a sentence on the cost if the build or the processor has no wider kernels; otherwise an
/// empty text. (benchmarks/results has the times of all kernels.)
const char* slow_kernels_note();

}  // namespace snowshed
