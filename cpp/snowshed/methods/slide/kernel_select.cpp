// The kernels of the instruction set in use.
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"

namespace snowshed::methods::slide {

namespace baseline {
extern const Kernels kernel_table;
}
#ifdef SNOWSHED_HAS_KERNELS_avx2
namespace avx2 {
extern const Kernels kernel_table;
}
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx512
namespace avx512 {
extern const Kernels kernel_table;
}
#endif

const Kernels& chosen_kernels() {
  switch (kernel_variant()) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
    case KernelVariant::avx512:
      return avx512::kernel_table;
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
    case KernelVariant::avx2:
      return avx2::kernel_table;
#endif
    default:
      return baseline::kernel_table;
  }
}

}  // namespace snowshed::methods::slide
