# Lets the extension load on systems with an older glibc than this one (SNOWSHED_OLD_GLIBC), for
# wheels that are built without a container. The C++ library is linked statically, and functions that
# old systems lack are defined here. tools/release/portable.py takes the others in their first version.
option(SNOWSHED_OLD_GLIBC "Link the Python extension for older systems" OFF)

function(snowshed_for_old_glibc target)
  if(NOT SNOWSHED_OLD_GLIBC)
    return()
  endif()
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/tools/release/old_glibc.cpp)
  set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/tools/release/old_glibc.cpp PROPERTIES
    SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  target_link_options(${target} PRIVATE -static-libstdc++ -Wl,--exclude-libs,ALL)
endfunction()
