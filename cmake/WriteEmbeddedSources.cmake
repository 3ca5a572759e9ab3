# Writes `output`, a source file with the texts of `files`, a list of NAME=FILE.
set(content "// Written by the build, see cmake/EmbeddedSources.cmake.
#include \"snowshed/gpu/embedded_sources.hpp\"

namespace snowshed::gpu {

const std::vector<SourceText>& embedded_sources() {
  static const std::vector<SourceText> sources{
")
foreach(entry IN LISTS files)
  string(REGEX MATCH "^([^=]+)=(.+)$" matches "${entry}")
  set(name ${CMAKE_MATCH_1})
  file(READ ${CMAKE_MATCH_2} text)
  string(APPEND content "{\"${name}\", R\"snowshed(${text})snowshed\"},\n")
endforeach()
string(APPEND content "  };
  return sources;
}

}  // namespace snowshed::gpu
")
file(WRITE ${output} "${content}")
