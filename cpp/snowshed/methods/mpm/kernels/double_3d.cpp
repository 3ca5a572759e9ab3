#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_VARIANT_BEGIN
Kernels<double> double_3d(const KernelChoice& choice) { return table<double, 3>(choice); }
SNOWSHED_VARIANT_END
