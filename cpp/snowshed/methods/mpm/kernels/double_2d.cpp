#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_VARIANT_BEGIN
Kernels<double> double_2d(const KernelChoice& choice) { return table<double, 2>(choice); }
SNOWSHED_VARIANT_END
