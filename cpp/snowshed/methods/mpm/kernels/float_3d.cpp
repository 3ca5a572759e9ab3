#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_VARIANT_BEGIN
Kernels<float> float_3d(const KernelChoice& choice) { return table<float, 3>(choice); }
SNOWSHED_VARIANT_END
