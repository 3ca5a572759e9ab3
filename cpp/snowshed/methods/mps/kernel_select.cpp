// The kernels of the instruction set in use.
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"

namespace snowshed {

namespace baseline {
extern const MpsKernels<2> mps_kernel_table_2d;
extern const MpsKernels<3> mps_kernel_table_3d;
}  // namespace baseline
#ifdef SNOWSHED_HAS_KERNELS_avx2
namespace avx2 {
extern const MpsKernels<2> mps_kernel_table_2d;
extern const MpsKernels<3> mps_kernel_table_3d;
}  // namespace avx2
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx512
namespace avx512 {
extern const MpsKernels<2> mps_kernel_table_2d;
extern const MpsKernels<3> mps_kernel_table_3d;
}  // namespace avx512
#endif

namespace {

template <int D>
const MpsKernels<D>& chosen(const MpsKernels<2>& plane, const MpsKernels<3>& space) {
  if constexpr (D == 2)
    return plane;
  else
    return space;
}

}  // namespace

template <int D>
const MpsKernels<D>& mps_kernels() {
  switch (chosen_kernel_variant()) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
    case KernelVariant::avx512:
      return chosen<D>(avx512::mps_kernel_table_2d, avx512::mps_kernel_table_3d);
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
    case KernelVariant::avx2:
      return chosen<D>(avx2::mps_kernel_table_2d, avx2::mps_kernel_table_3d);
#endif
    default:
      return chosen<D>(baseline::mps_kernel_table_2d, baseline::mps_kernel_table_3d);
  }
}

template const MpsKernels<2>& mps_kernels();
template const MpsKernels<3>& mps_kernels();

}  // namespace snowshed
