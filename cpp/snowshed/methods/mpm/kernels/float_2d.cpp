#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_VARIANT_BEGIN
Kernels<float> float_2d(const KernelChoice& choice) { return table<float, 2>(choice); }
SNOWSHED_VARIANT_END
