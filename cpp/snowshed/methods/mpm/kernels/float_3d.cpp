#include "snowshed/methods/mpm/kernels/table.hpp"

SNOWSHED_MODULE_VARIANT_BEGIN(methods::mpm)
Kernels<float> float_3d(const KernelChoice& choice) { return table<float, 3>(choice); }
SNOWSHED_MODULE_VARIANT_END
