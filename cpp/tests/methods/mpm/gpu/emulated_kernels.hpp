// The kernels of the material point method for the emulated device.
#pragma once

#include "gpu/emulated_device.hpp"

namespace snowshed::methods::mpm {

const snowshed::gpu::EmulatedDevice::Kernels& emulated_kernels();

}  // namespace snowshed::methods::mpm
