# OpenVDB, where it is there, for the program snowshed-vdb; all else is built without it.
set(SNOWSHED_WITH_OPENVDB AUTO CACHE STRING "Read and write OpenVDB files: AUTO, ON or OFF")
set_property(CACHE SNOWSHED_WITH_OPENVDB PROPERTY STRINGS AUTO ON OFF)

set(SNOWSHED_HAS_OPENVDB FALSE)
if(SNOWSHED_SANITIZE AND SNOWSHED_WITH_OPENVDB STREQUAL "AUTO")
  return()  # its libraries are not instrumented
endif()
if(NOT SNOWSHED_WITH_OPENVDB STREQUAL "OFF")
  find_path(SNOWSHED_OPENVDB_DIR openvdb/openvdb.h)
  find_library(SNOWSHED_OPENVDB_LIBRARY openvdb)
  find_library(SNOWSHED_TBB_LIBRARY tbb)
  find_path(SNOWSHED_BOOST_DIR boost/numeric/conversion/conversion_traits.hpp)
  find_path(SNOWSHED_IMATH_DIR half.h PATH_SUFFIXES Imath)  # only some packages need it
  set(snowshed_openvdb_headers ${SNOWSHED_OPENVDB_DIR} ${SNOWSHED_BOOST_DIR})
  if(SNOWSHED_IMATH_DIR)
    list(APPEND snowshed_openvdb_headers ${SNOWSHED_IMATH_DIR})
  endif()
  set(snowshed_openvdb_libraries ${SNOWSHED_OPENVDB_LIBRARY} ${SNOWSHED_TBB_LIBRARY})
  if(SNOWSHED_OPENVDB_DIR AND SNOWSHED_BOOST_DIR AND SNOWSHED_OPENVDB_LIBRARY AND SNOWSHED_TBB_LIBRARY)
    set(SNOWSHED_HAS_OPENVDB TRUE)
  elseif(SNOWSHED_WITH_OPENVDB STREQUAL "ON")
    message(FATAL_ERROR "OpenVDB not found: install libopenvdb-dev and libboost-dev")
  endif()
endif()
message(STATUS "OpenVDB: ${SNOWSHED_HAS_OPENVDB}")

# Makes a target include and link OpenVDB; its own warnings are not ours.
function(snowshed_use_openvdb target)
  target_include_directories(${target} SYSTEM PUBLIC ${snowshed_openvdb_headers})
  target_link_libraries(${target} PUBLIC ${snowshed_openvdb_libraries})
endfunction()
