# The kernels (cpp/snowshed/methods/*/kernels/*.cpp) are compiled once for each instruction set. The
# best variant is chosen at run time, so one build runs on any machine and is fast on each.
set(SNOWSHED_KERNEL_FLAGS_baseline "")
set(SNOWSHED_KERNEL_FLAGS_avx2 -mavx2 -mfma -mf16c -mbmi -mbmi2)
set(SNOWSHED_KERNEL_FLAGS_avx512
  -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mbmi -mbmi2 -mprefer-vector-width=512)

if(SNOWSHED_SANITIZE)
  set(snowshed_default_variants baseline)  # all variants come from the same templates
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  set(snowshed_default_variants baseline avx2 avx512)
  set(SNOWSHED_KERNEL_FLAGS_baseline -O1)  # builds in half the time; for processors without AVX2
else()
  set(snowshed_default_variants baseline)
endif()
set(SNOWSHED_KERNEL_VARIANTS ${snowshed_default_variants} CACHE STRING "instruction sets to build the kernels for")

function(snowshed_add_kernels target)
  file(GLOB kernel_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/cpp/snowshed/methods/*/kernels/*.cpp)
  foreach(variant IN LISTS SNOWSHED_KERNEL_VARIANTS)
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
