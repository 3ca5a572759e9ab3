#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_METHOD_VARIANT_BEGIN(mpm)
Kernels<double> double_3d(const KernelChoice& choice) { return table<double, 3>(choice); }
SNOWSHED_METHOD_VARIANT_END
