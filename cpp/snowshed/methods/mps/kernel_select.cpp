// The kernels of the instruction set in use.
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"

namespace snowshed::methods::mps {

namespace baseline {
extern const Kernels<2> kernel_table_2d;
extern const Kernels<3> kernel_table_3d;
}  // namespace baseline
#ifdef SNOWSHED_HAS_KERNELS_avx2
namespace avx2 {
extern const Kernels<2> kernel_table_2d;
extern const Kernels<3> kernel_table_3d;
}  // namespace avx2
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx512
namespace avx512 {
extern const Kernels<2> kernel_table_2d;
extern const Kernels<3> kernel_table_3d;
}  // namespace avx512
#endif

namespace {

template <int D>
const Kernels<D>& chosen(const Kernels<2>& plane, const Kernels<3>& space) {
  if constexpr (D == 2)
    return plane;
  else
    return space;
}

}  // namespace

template <int D>
const Kernels<D>& chosen_kernels() {
  switch (kernel_variant()) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
    case KernelVariant::avx512:
      return chosen<D>(avx512::kernel_table_2d, avx512::kernel_table_3d);
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
    case KernelVariant::avx2:
      return chosen<D>(avx2::kernel_table_2d, avx2::kernel_table_3d);
#endif
    default:
      return chosen<D>(baseline::kernel_table_2d, baseline::kernel_table_3d);
  }
}

template const Kernels<2>& chosen_kernels();
template const Kernels<3>& chosen_kernels();

}  // namespace snowshed::methods::mps
