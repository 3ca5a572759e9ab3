# Finds Eigen, nlohmann-json and zlib. The system's packages are preferred.
# The Python wheels `cmeel-eigen`, `nlohmann-json` and `cmeel-zlib` contain the same. This file is
# part of the installed library, whose `snowshed_dependency_hints` are searched first.
if(TARGET snowshed_headers)
  return()
endif()
add_library(snowshed_headers INTERFACE)

find_package(Python COMPONENTS Interpreter QUIET)
set(snowshed_site_packages "")
if(Python_Interpreter_FOUND)
  execute_process(
    COMMAND ${Python_EXECUTABLE} -c "import sys; print(';'.join(p for p in sys.path if p.endswith('-packages')))"
    OUTPUT_VARIABLE snowshed_site_packages OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()

find_path(SNOWSHED_EIGEN_DIR Eigen/Core HINTS ${snowshed_dependency_hints}
  PATHS ${snowshed_site_packages} PATH_SUFFIXES eigen3 include/eigen3 cmeel.prefix/include/eigen3)
find_path(SNOWSHED_JSON_DIR nlohmann/json.hpp HINTS ${snowshed_dependency_hints}
  PATHS ${snowshed_site_packages} PATH_SUFFIXES include nlohmann_json/include)
foreach(header EIGEN JSON)
  if(NOT SNOWSHED_${header}_DIR)
    message(FATAL_ERROR "${header} headers not found: install libeigen3-dev and nlohmann-json3-dev, "
      "or `pip install cmeel-eigen nlohmann-json`")
  endif()
  target_include_directories(snowshed_headers SYSTEM INTERFACE ${SNOWSHED_${header}_DIR})
endforeach()

find_path(SNOWSHED_ZLIB_DIR zlib.h HINTS ${snowshed_dependency_hints}
  PATHS ${snowshed_site_packages} PATH_SUFFIXES cmeel.prefix/include)
find_library(SNOWSHED_ZLIB_LIBRARY NAMES z HINTS ${snowshed_dependency_hints})
find_library(SNOWSHED_ZLIB_LIBRARY NAMES libz.so z
  PATHS ${snowshed_site_packages} PATH_SUFFIXES cmeel.prefix/lib64 cmeel.prefix/lib)
if(NOT SNOWSHED_ZLIB_DIR OR NOT SNOWSHED_ZLIB_LIBRARY)
  message(FATAL_ERROR "zlib not found: install zlib1g-dev, or `pip install cmeel-zlib`")
endif()
target_include_directories(snowshed_headers SYSTEM INTERFACE ${SNOWSHED_ZLIB_DIR})
target_link_libraries(snowshed_headers INTERFACE ${SNOWSHED_ZLIB_LIBRARY})
