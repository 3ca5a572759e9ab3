// Picks, once, the widest instruction set that both the build and the machine have.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
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
constexpr Variant all_variants[] = {Variant::baseline, Variant::avx2, Variant::avx512};

const char* name_of(Variant variant) {
  switch (variant) {
    case Variant::avx512:
      return "avx512";
    case Variant::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

/// Whether both the build and the machine have a variant.
bool is_supported(Variant variant) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
  if (variant == Variant::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
  if (variant == Variant::avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
#endif
  return variant == Variant::baseline;
}

std::vector<Variant> supported_variants() {
  std::vector<Variant> supported;
  std::copy_if(std::begin(all_variants), std::end(all_variants), std::back_inserter(supported),
               is_supported);
  return supported;
}

template <class Variants>
std::string list_of(const Variants& variants) {
  std::string list;
  for (const Variant v : variants) list += (list.empty() ? "" : ", ") + std::string(name_of(v));
  return list;
}

/// The widest variant that runs here, or the one that the user asks for.
Variant chosen_variant() {
  const std::vector<Variant> supported = supported_variants();
  const char* forced = std::getenv("SNOWSHED_KERNELS");
  if (!forced || !*forced) return supported.back();
  for (const Variant v : supported)
    if (std::strcmp(forced, name_of(v)) == 0) return v;
  throw InputError("SNOWSHED_KERNELS", "is \"" + std::string(forced) +
                                           "\"; allowed: " + list_of(all_variants) +
                                           "; this machine can run: " + list_of(supported));
}

Variant variant() {
  static const Variant chosen = chosen_variant();
  return chosen;
}

template <class T>
Kernels<T> from(Kernels<T> (*two)(const KernelChoice&), Kernels<T> (*three)(const KernelChoice&),
                const KernelChoice& choice) {
  return choice.dimension == 2 ? two(choice) : three(choice);
}

}  // namespace

const char* kernel_variant() { return name_of(variant()); }

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
