#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_METHOD_VARIANT_BEGIN(mpm)
Kernels<double> double_2d(const KernelChoice& choice) { return table<double, 2>(choice); }
SNOWSHED_METHOD_VARIANT_END
