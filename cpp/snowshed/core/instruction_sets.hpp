// The instruction sets that kernels are compiled for, and which of them this machine has.
#pragma once

namespace snowshed {

enum class KernelVariant { baseline, avx2, avx512 };

/// All of them, the narrowest first.
inline constexpr KernelVariant all_variants[] = {KernelVariant::baseline, KernelVariant::avx2,
                                                 KernelVariant::avx512};

inline const char* name_of(KernelVariant variant) {
  switch (variant) {
    case KernelVariant::avx512:
      return "avx512";
    case KernelVariant::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

/// Returns whether this processor has all instructions that the variant's kernels use.
inline bool machine_has(KernelVariant variant) {
#if defined(__x86_64__)
  if (variant == KernelVariant::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  if (variant == KernelVariant::avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
#endif
  return variant == KernelVariant::baseline;
}

}  // namespace snowshed
