#!/bin/sh
# Runs clang-tidy over the core, from a tree of its own: one source at a time, as clang-tidy looks.
set -eu
tree=build/tidy

cmake -S . -B "$tree" -DSNOWSHED_UNITY_BUILD=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null
# The compiler's own omp.h, alone: clang brings the other headers of this kind itself.
mkdir -p "$tree/openmp"
cp "$(${CXX:-c++} -print-file-name=include/omp.h)" "$tree/openmp/"
find cpp/apps cpp/snowshed -name '*.cpp' -print0 |
  xargs -0 -n 1 -P 2 clang-tidy --quiet -p "$tree" --extra-arg="-isystem$PWD/$tree/openmp"
