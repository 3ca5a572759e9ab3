#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)
Kernels<double> double_3d(const KernelChoice& choice) { return table<double, 3>(choice); }
SNOWSHED_MODULE_VARIANT_END
