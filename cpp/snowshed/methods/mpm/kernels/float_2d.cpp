#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_METHOD_VARIANT_BEGIN(mpm)
Kernels<float> float_2d(const KernelChoice& choice) { return table<float, 2>(choice); }
SNOWSHED_METHOD_VARIANT_END
