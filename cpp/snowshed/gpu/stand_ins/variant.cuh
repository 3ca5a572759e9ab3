// Stands in for core/variant.hpp on a graphics card, which has one instruction set at a time.
#pragma once

#define SNOWSHED_VARIANT_BEGIN \
  namespace snowshed {         \
  inline namespace card {
#define SNOWSHED_VARIANT_END \
  }                          \
  }

#define SNOWSHED_MODULE_VARIANT_BEGIN(module) \
  namespace snowshed {                        \
  namespace module {                          \
  inline namespace card {
#define SNOWSHED_MODULE_VARIANT_END \
  }                                 \
  }                                 \
  }

#define SNOWSHED_INLINE inline __attribute__((always_inline))
#define SNOWSHED_UNROLL _Pragma("unroll")
#define SNOWSHED_INLINE_LAMBDA
