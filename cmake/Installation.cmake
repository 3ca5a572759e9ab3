# Installs the library for other CMake projects, which use it by find_package(snowshed). A tree that
# builds the Python package leaves it out of wheels; there it is installed by
#   cmake --install TREE --component development --prefix FOLDER
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(snowshed_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/snowshed)
set(snowshed_rule COMPONENT development)
if(SNOWSHED_BUILD_PYTHON)
  list(APPEND snowshed_rule EXCLUDE_FROM_ALL)
endif()

install(TARGETS snowshed EXPORT snowshedTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${snowshed_rule}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT snowshedTargets NAMESPACE snowshed:: DESTINATION ${snowshed_package_folder}
  ${snowshed_rule})
install(DIRECTORY cpp/snowshed ${CMAKE_CURRENT_BINARY_DIR}/include/snowshed
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${snowshed_rule}
  FILES_MATCHING PATTERN "*.hpp" PATTERN kernels EXCLUDE)

get_filename_component(snowshed_zlib_folder ${SNOWSHED_ZLIB_LIBRARY} DIRECTORY)
configure_package_config_file(cmake/snowshedConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/snowshedConfig.cmake
  INSTALL_DESTINATION ${snowshed_package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/snowshedConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/snowshedConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/snowshedConfigVersion.cmake
  cmake/Dependencies.cmake
  DESTINATION ${snowshed_package_folder} ${snowshed_rule})
