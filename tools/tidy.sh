#!/bin/sh
# Runs clang-tidy on the core, in a separate build tree that compiles one source at a time.
set -eu
tree=build/tidy

cmake -S . -B "$tree" -DSNOWSHED_UNITY_BUILD=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null
# Provide the compiler's omp.h alone; clang has its own versions of the other compiler headers.
mkdir -p "$tree/openmp"
cp "$(${CXX:-c++} -print-file-name=include/omp.h)" "$tree/openmp/"
find cpp/apps cpp/snowshed -name '*.cpp' -print0 |
  xargs -0 -n 1 -P 2 clang-tidy --quiet -p "$tree" --extra-arg="-isystem$PWD/$tree/openmp"
