// The kernels of grains for one instruction set.
#include "snowshed/methods/grains/kernels/pair_forces.hpp"

SNOWSHED_VARIANT_BEGIN
namespace {

void pair_forces(const GrainsView& s, std::size_t group) { group_forces(s, group); }

}  // namespace

extern const GrainsKernels grains_kernel_table;
const GrainsKernels grains_kernel_table{&pair_forces};

SNOWSHED_VARIANT_END
