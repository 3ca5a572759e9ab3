// The kernels of grains for one instruction set.
#include "snowshed/methods/grains/kernels/pair_forces.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::grains)
namespace {

void pair_forces(const View& s, std::size_t group) { group_forces(s, group); }

}  // namespace

extern const Kernels kernel_table;
const Kernels kernel_table{&pair_forces};

SNOWSHED_MODULE_VARIANT_END
