# Sanitizers for tests: SNOWSHED_SANITIZE=address finds memory errors and undefined behaviour,
# SNOWSHED_SANITIZE=thread finds data races. See docs/trust/robustness.md.
set(SNOWSHED_SANITIZE "" CACHE STRING "sanitizers: address (and undefined behaviour), thread, or empty")
set_property(CACHE SNOWSHED_SANITIZE PROPERTY STRINGS "" address thread)

set(snowshed_sanitizers_address -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)
set(snowshed_sanitizers_thread -fsanitize=thread)

set(snowshed_default_build_type Release)
set(snowshed_kernel_optimisation -O3)
if(SNOWSHED_SANITIZE)
  if(NOT DEFINED snowshed_sanitizers_${SNOWSHED_SANITIZE})
    message(FATAL_ERROR "SNOWSHED_SANITIZE is '${SNOWSHED_SANITIZE}'; allowed: address, thread, or nothing")
  endif()
  set(snowshed_default_build_type Debug)  # assertions on
  set(snowshed_kernel_optimisation -O1)
  add_compile_options(${snowshed_sanitizers_${SNOWSHED_SANITIZE}} -O1 -g1 -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # has false positives with sanitizers
  add_link_options(${snowshed_sanitizers_${SNOWSHED_SANITIZE}})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  if(SNOWSHED_SANITIZE STREQUAL "thread")
    add_compile_definitions(SNOWSHED_IN_TURN)  # neighbouring iterations on different threads
  endif()
endif()
