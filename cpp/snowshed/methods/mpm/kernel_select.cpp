// The kernels of the instruction set in use.
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed::methods::mpm {

#define SNOWSHED_DECLARE(variant)                 \
  namespace variant {                             \
  Kernels<float> float_2d(const KernelChoice&);   \
  Kernels<float> float_3d(const KernelChoice&);   \
  Kernels<double> double_2d(const KernelChoice&); \
  Kernels<double> double_3d(const KernelChoice&); \
  }
SNOWSHED_DECLARE(baseline)
#ifdef SNOWSHED_HAS_KERNELS_avx2
SNOWSHED_DECLARE(avx2)
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx512
SNOWSHED_DECLARE(avx512)
#endif
#undef SNOWSHED_DECLARE

namespace {

template <class T>
Kernels<T> from(Kernels<T> (*two)(const KernelChoice&), Kernels<T> (*three)(const KernelChoice&),
                const KernelChoice& choice) {
  return choice.dimension == 2 ? two(choice) : three(choice);
}

}  // namespace

#define SNOWSHED_SELECT(T)                                       \
  template <>                                                    \
  Kernels<T> select_kernels<T>(const KernelChoice& choice) {     \
    switch (kernel_variant()) {                                  \
      SNOWSHED_CASE_AVX512(T)                                    \
      SNOWSHED_CASE_AVX2(T)                                      \
      default:                                                   \
        return from(baseline::T##_2d, baseline::T##_3d, choice); \
    }                                                            \
  }
#ifdef SNOWSHED_HAS_KERNELS_avx512
#define SNOWSHED_CASE_AVX512(T) \
  case KernelVariant::avx512:   \
    return from(avx512::T##_2d, avx512::T##_3d, choice);
#else
#define SNOWSHED_CASE_AVX512(T)
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
#define SNOWSHED_CASE_AVX2(T) \
  case KernelVariant::avx2:   \
    return from(avx2::T##_2d, avx2::T##_3d, choice);
#else
#define SNOWSHED_CASE_AVX2(T)
#endif

SNOWSHED_SELECT(float)
SNOWSHED_SELECT(double)
#undef SNOWSHED_SELECT
#undef SNOWSHED_CASE_AVX512
#undef SNOWSHED_CASE_AVX2

}  // namespace snowshed::methods::mpm
