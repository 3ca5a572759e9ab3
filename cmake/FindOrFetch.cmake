# Provides a library for tests or benchmarks: that of the system, or else its release from the web.
include(FetchContent)

# Do not install these libraries and do not build their tests.
set(INSTALL_GTEST OFF CACHE BOOL "" FORCE)
set(BUILD_GMOCK OFF CACHE BOOL "" FORCE)
set(BENCHMARK_ENABLE_INSTALL OFF CACHE BOOL "" FORCE)
set(BENCHMARK_ENABLE_TESTING OFF CACHE BOOL "" FORCE)

function(snowshed_find_or_fetch package url system_package)
  find_package(${package} QUIET)
  if(${package}_FOUND)
    return()
  endif()
  message(STATUS "${package} is not installed: fetching ${url}")
  set(archive ${CMAKE_BINARY_DIR}/downloads/${package}.tar.gz)
  if(NOT EXISTS ${archive})
    file(DOWNLOAD ${url} ${archive}.partial STATUS status TIMEOUT 120)
    if(NOT status MATCHES "^0;")
      file(REMOVE ${archive}.partial)
      message(FATAL_ERROR "${package} is needed and could not be fetched (${status}).\n"
        "Install ${system_package} (Debian, Ubuntu) or the like, or make the network available.")
    endif()
    file(RENAME ${archive}.partial ${archive})
  endif()
  FetchContent_Declare(${package} URL ${archive} DOWNLOAD_EXTRACT_TIMESTAMP TRUE)
  FetchContent_MakeAvailable(${package})
endfunction()
