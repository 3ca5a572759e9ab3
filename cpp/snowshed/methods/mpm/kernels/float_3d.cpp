#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_METHOD_VARIANT_BEGIN(mpm)
Kernels<float> float_3d(const KernelChoice& choice) { return table<float, 3>(choice); }
SNOWSHED_METHOD_VARIANT_END
