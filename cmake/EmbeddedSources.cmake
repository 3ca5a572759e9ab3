# Puts the sources of kernels for graphics cards into the library as texts: the kernels themselves,
# headers of the core that they share with the processor, and what stands in for headers that only a
# processor can compile. A header's name here is its name in includes.
set(snowshed_shared_sources
  material/cam_clay.hpp
  material/elastic.hpp
  material/elasticity.hpp
  material/sym_tensor.hpp)
set(snowshed_stand_ins
  cmath=cmath.cuh
  cstdint=cstdint.cuh
  snowshed/core/simd_math.hpp=simd_math.cuh
  snowshed/core/simd_pack.hpp=simd_pack.cuh
  snowshed/core/variant.hpp=variant.cuh)

function(snowshed_embed_sources library)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/cpp/snowshed)
  file(GLOB kernels RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/methods/*/gpu/*.cuh)
  set(entries "")
  foreach(source IN LISTS snowshed_shared_sources kernels)
    list(APPEND entries snowshed/${source}=${folder}/${source})
  endforeach()
  foreach(stand_in IN LISTS snowshed_stand_ins)
    string(REPLACE "=" "=${folder}/gpu/stand_ins/" entry ${stand_in})
    list(APPEND entries ${entry})
  endforeach()
  list(TRANSFORM entries REPLACE "^[^=]+=" "" OUTPUT_VARIABLE files)
  set(writer ${CMAKE_CURRENT_SOURCE_DIR}/cmake/WriteEmbeddedSources.cmake)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/generated/embedded_sources.cpp)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${writer} VERBATIM
    COMMAND ${CMAKE_COMMAND} -D output=${output} -D "files=${entries}" -P ${writer})
  target_sources(${library} PRIVATE ${output})
endfunction()
