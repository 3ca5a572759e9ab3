# Compiles the digest of the sources and the commit into the library. Every build computes them anew,
# because a build may follow a change without a new configuration.
function(snowshed_add_build_id library)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/generated/source_id.cpp)
  set(command ${CMAKE_COMMAND} -D source=${CMAKE_CURRENT_SOURCE_DIR} -D output=${output}
    -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/WriteBuildId.cmake)
  execute_process(COMMAND ${command} COMMAND_ERROR_IS_FATAL ANY)
  add_custom_target(${library}_build_id COMMAND ${command} BYPRODUCTS ${output} VERBATIM)
  add_dependencies(${library} ${library}_build_id)
  target_sources(${library} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
