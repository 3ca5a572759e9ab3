# The kernels (cpp/snowshed/methods/*/kernels/*.cpp) are compiled once for each instruction set. The
# best variant is chosen at run time, so one build runs on any machine and is fast on each.
set(SNOWSHED_KERNEL_FLAGS_baseline "")
set(SNOWSHED_KERNEL_FLAGS_avx2 -mavx2 -mfma -mf16c -mbmi -mbmi2)
set(SNOWSHED_KERNEL_FLAGS_avx512
  -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mbmi -mbmi2 -mprefer-vector-width=512)

set(snowshed_all_variants baseline)
set(snowshed_default_variants native)
if(SNOWSHED_SANITIZE)
  set(snowshed_default_variants baseline)  # all variants come from the same templates
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  list(APPEND snowshed_all_variants avx2 avx512)
  # For processors without AVX2. -O1 builds in half the time, but gives false warnings.
  set(SNOWSHED_KERNEL_FLAGS_baseline -O1
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
set(SNOWSHED_KERNEL_VARIANTS ${snowshed_default_variants} CACHE STRING
  "instruction sets to build the kernels for: all, native (this machine's), or a list")

# Sets `result` to the meaning of `native`: the baseline, and the widest set that this machine runs.
function(snowshed_native_variants result)
  try_run(runs compiles ${CMAKE_CURRENT_BINARY_DIR}/widest_kernels
    ${CMAKE_CURRENT_SOURCE_DIR}/cpp/apps/widest_kernels.cpp
    CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${CMAKE_CURRENT_SOURCE_DIR}/cpp
    RUN_OUTPUT_VARIABLE widest)
  if(NOT compiles OR NOT runs EQUAL 0)
    message(FATAL_ERROR "cpp/apps/widest_kernels.cpp does not run here; "
      "-DSNOWSHED_KERNEL_VARIANTS=all builds the kernels for every machine")
  endif()
  set(variants baseline ${widest})
  list(REMOVE_DUPLICATES variants)
  set(${result} ${variants} PARENT_SCOPE)
endfunction()

if(SNOWSHED_KERNEL_VARIANTS STREQUAL "all")
  set(snowshed_kernel_variants ${snowshed_all_variants})
elseif(SNOWSHED_KERNEL_VARIANTS STREQUAL "native")
  snowshed_native_variants(snowshed_kernel_variants)
else()
  set(snowshed_kernel_variants ${SNOWSHED_KERNEL_VARIANTS})
endif()
message(STATUS "Kernels: ${snowshed_kernel_variants}")

function(snowshed_add_kernels target)
  file(GLOB kernel_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/cpp/snowshed/methods/*/kernels/*.cpp)
  foreach(variant IN LISTS snowshed_kernel_variants)
    set(kernels ${target}_kernels_${variant})
    add_library(${kernels} OBJECT ${kernel_sources})
    target_include_directories(${kernels} PRIVATE cpp)
    target_link_libraries(${kernels} PRIVATE snowshed_headers)
    target_compile_definitions(${kernels} PRIVATE SNOWSHED_KERNEL_VARIANT=${variant})
    target_compile_options(${kernels} PRIVATE -Wno-ignored-attributes
      ${snowshed_kernel_optimisation} -fno-math-errno -fno-trapping-math -Wall -Wextra -Wno-psabi ${SNOWSHED_KERNEL_FLAGS_${variant}})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernels}>)
    target_compile_definitions(${target} PRIVATE SNOWSHED_HAS_KERNELS_${variant})
  endforeach()
endfunction()
