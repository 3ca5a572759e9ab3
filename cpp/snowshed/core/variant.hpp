// Code that the kernels share lives in a namespace named after the instruction set it is
// compiled for, so that the linker never mixes an AVX-512 copy of an inline function into the
// build for older machines. Everywhere else the inline namespace is `host`.
#pragma once

#ifndef SNOWSHED_KERNEL_VARIANT
#define SNOWSHED_KERNEL_VARIANT host
#endif

#define SNOWSHED_VARIANT_BEGIN \
  namespace snowshed {         \
  inline namespace SNOWSHED_KERNEL_VARIANT {
#define SNOWSHED_VARIANT_END \
  }                          \
  }

// The same within the namespace of a module, such as `material` or `methods::mpm`.
#define SNOWSHED_MODULE_VARIANT_BEGIN(module) \
  namespace snowshed {                        \
  namespace module {                          \
  inline namespace SNOWSHED_KERNEL_VARIANT {
#define SNOWSHED_MODULE_VARIANT_END \
  }                                 \
  }                                 \
  }

#define SNOWSHED_INLINE inline __attribute__((always_inline))
// Arrays of packs stay in registers only if the loops over them are unrolled early.
#if defined(__clang__)
#define SNOWSHED_UNROLL _Pragma("clang loop unroll(full)")
#else
#define SNOWSHED_UNROLL _Pragma("GCC unroll 64")
#endif
#define SNOWSHED_INLINE_LAMBDA __attribute__((always_inline))
