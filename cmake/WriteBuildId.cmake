# Writes `output`, a source file with the digest of the library's sources and the commit of the tree
# `source`. An unchanged file keeps its time, so that nothing is compiled again.
file(GLOB_RECURSE files RELATIVE ${source} ${source}/cpp/snowshed/*)
list(SORT files)
set(digests "")
foreach(file IN LISTS files)
  file(SHA256 ${source}/${file} digest)
  string(APPEND digests "${file} ${digest}\n")
endforeach()
string(SHA256 build_id "${digests}")
string(SUBSTRING ${build_id} 0 12 build_id)

set(build_commit "")
if(EXISTS ${source}/.git)
  find_program(git git)
  if(git)
    execute_process(COMMAND ${git} describe --always --dirty --tags WORKING_DIRECTORY ${source}
      OUTPUT_VARIABLE build_commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
configure_file(${source}/cpp/snowshed/core/build_id.cpp.in ${output} @ONLY)
