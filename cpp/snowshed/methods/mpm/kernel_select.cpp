// Picks, once, the widest instruction set that both the build and the machine have.
#include <cstdlib>
#include <cstring>

#include "snowshed/methods/mpm/kernel_api.hpp"

namespace snowshed {

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

enum class Variant { baseline, avx2, avx512 };

[[maybe_unused]] bool wanted(const char* name) {
  const char* forced = std::getenv("SNOWSHED_KERNELS");
  return !forced || std::strcmp(forced, name) == 0;
}

Variant best_variant() {
#ifdef SNOWSHED_HAS_KERNELS_avx512
  if (wanted("avx512") && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    return Variant::avx512;
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
  if (wanted("avx2") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    return Variant::avx2;
#endif
  return Variant::baseline;
}

Variant variant() {
  static const Variant chosen = best_variant();
  return chosen;
}

template <class T>
Kernels<T> from(Kernels<T> (*two)(const KernelChoice&), Kernels<T> (*three)(const KernelChoice&),
                const KernelChoice& choice) {
  return choice.dimension == 2 ? two(choice) : three(choice);
}

}  // namespace

const char* kernel_variant() {
  switch (variant()) {
    case Variant::avx512:
      return "avx512";
    case Variant::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

#define SNOWSHED_SELECT(T)                                       \
  template <>                                                    \
  Kernels<T> select_kernels<T>(const KernelChoice& choice) {     \
    switch (variant()) {                                         \
      SNOWSHED_CASE_AVX512(T)                                    \
      SNOWSHED_CASE_AVX2(T)                                      \
      default:                                                   \
        return from(baseline::T##_2d, baseline::T##_3d, choice); \
    }                                                            \
  }
#ifdef SNOWSHED_HAS_KERNELS_avx512
#define SNOWSHED_CASE_AVX512(T) \
  case Variant::avx512:         \
    return from(avx512::T##_2d, avx512::T##_3d, choice);
#else
#define SNOWSHED_CASE_AVX512(T)
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
#define SNOWSHED_CASE_AVX2(T) \
  case Variant::avx2:         \
    return from(avx2::T##_2d, avx2::T##_3d, choice);
#else
#define SNOWSHED_CASE_AVX2(T)
#endif

SNOWSHED_SELECT(float)
SNOWSHED_SELECT(double)
#undef SNOWSHED_SELECT
#undef SNOWSHED_CASE_AVX512
#undef SNOWSHED_CASE_AVX2

}  // namespace snowshed
