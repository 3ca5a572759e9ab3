# Coverage-guided fuzzing with libFuzzer, a part of clang. Other compilers build the same targets as
# programs that replay given inputs.
option(SNOWSHED_BUILD_FUZZ "Build the fuzz targets" OFF)
if(NOT SNOWSHED_BUILD_FUZZ)
  return()
endif()

include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
check_cxx_source_compiles("
  #include <cstddef>
  extern \"C\" int LLVMFuzzerTestOneInput(const unsigned char*, std::size_t) { return 0; }"
  SNOWSHED_HAS_LIBFUZZER)
unset(CMAKE_REQUIRED_FLAGS)
if(SNOWSHED_HAS_LIBFUZZER)
  add_compile_options(-fsanitize=fuzzer-no-link)  # measures coverage of the whole core
endif()

function(snowshed_add_fuzz_target name source)
  add_executable(fuzz_${name} ${source})
  target_link_libraries(fuzz_${name} PRIVATE snowshed)
  if(SNOWSHED_HAS_LIBFUZZER)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  else()
    target_sources(fuzz_${name} PRIVATE replay_main.cpp)
  endif()
endfunction()
