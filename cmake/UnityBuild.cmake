# Most of the build time goes into headers of libraries and into templates that each source
# instantiates again. The compiler therefore gets several sources at a time, and the libraries'
# headers precompiled. Sanitized builds compile each source alone, which shows that every source
# includes what it needs.
if(SNOWSHED_SANITIZE)
  set(snowshed_default_batches OFF)
else()
  set(snowshed_default_batches ON)
endif()
option(SNOWSHED_UNITY_BUILD "Compile several sources at a time" ${snowshed_default_batches})

# Compiles `size` sources at a time. The arguments after `size` are library headers that most of the
# sources include.
function(snowshed_in_batches target size)
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD ${SNOWSHED_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${size})
  if(SNOWSHED_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()
