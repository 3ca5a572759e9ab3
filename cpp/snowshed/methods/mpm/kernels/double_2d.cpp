#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)
Kernels<double> double_2d(const KernelChoice& choice) { return table<double, 2>(choice); }
SNOWSHED_MODULE_VARIANT_END
