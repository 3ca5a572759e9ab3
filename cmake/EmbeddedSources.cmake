# Puts the sources of kernels for graphics cards into the library as texts: the kernels themselves,
# the headers that they share with the processor, and what stands in for headers that only a
# processor can compile. A header's name here is its name in includes.
set(snowshed_stand_ins
  cmath=cmath.cuh
  cstdint=cstdint.cuh
  snowshed/core/simd_math.hpp=simd_math.cuh
  snowshed/core/simd_pack.hpp=simd_pack.cuh
  snowshed/core/variant.hpp=variant.cuh)

# The first sources; the headers of the library that they include follow by themselves.
set(snowshed_card_sources
  snowshed/material/cam_clay.hpp
  snowshed/material/elastic.hpp
  snowshed/material/elasticity.hpp
  snowshed/material/sym_tensor.hpp)

# Sets `result` to some sources and all headers of the library that they include, directly or not,
# except those for which something stands in.
function(snowshed_with_included result folder)
  set(sources "")
  set(left ${ARGN})
  while(left)
    list(POP_FRONT left source)
    if(source IN_LIST sources OR "${snowshed_stand_ins}" MATCHES "(^|;)${source}=")
      continue()
    endif()
    list(APPEND sources ${source})
    file(STRINGS ${folder}/${source} includes REGEX "^#include \"snowshed/")
    foreach(include IN LISTS includes)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" header "${include}")
      list(APPEND left ${header})
    endforeach()
  endwhile()
  set(${result} ${sources} PARENT_SCOPE)
endfunction()

function(snowshed_embed_sources library)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/cpp)
  file(GLOB kernels RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/snowshed/methods/*/gpu/*.cuh)
  snowshed_with_included(sources ${folder} ${snowshed_card_sources} ${kernels})
  set(entries "")
  foreach(source IN LISTS sources)
    list(APPEND entries ${source}=${folder}/${source})
  endforeach()
  foreach(stand_in IN LISTS snowshed_stand_ins)
    string(REPLACE "=" "=${folder}/snowshed/gpu/stand_ins/" entry ${stand_in})
    list(APPEND entries ${entry})
  endforeach()
  list(TRANSFORM entries REPLACE "^[^=]+=" "" OUTPUT_VARIABLE files)
  # A changed source may include another header.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
  set(writer ${CMAKE_CURRENT_SOURCE_DIR}/cmake/WriteEmbeddedSources.cmake)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/generated/embedded_sources.cpp)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${writer} VERBATIM
    COMMAND ${CMAKE_COMMAND} -D output=${output} -D "files=${entries}" -P ${writer})
  target_sources(${library} PRIVATE ${output})
endfunction()
