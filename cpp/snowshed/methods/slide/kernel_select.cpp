// The kernels of the instruction set in use.
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/methods/slide/kernel_api.hpp"

namespace snowshed {

namespace baseline {
extern const SlideKernels slide_kernel_table;
}
#ifdef SNOWSHED_HAS_KERNELS_avx2
namespace avx2 {
extern const SlideKernels slide_kernel_table;
}
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx512
namespace avx512 {
extern const SlideKernels slide_kernel_table;
}
#endif

const SlideKernels& slide_kernels() {
  switch (chosen_kernel_variant()) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
    case KernelVariant::avx512:
      return avx512::slide_kernel_table;
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
    case KernelVariant::avx2:
      return avx2::slide_kernel_table;
#endif
    default:
      return baseline::slide_kernel_table;
  }
}

}  // namespace snowshed
