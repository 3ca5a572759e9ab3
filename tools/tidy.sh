#!/bin/sh
# Runs clang-tidy over the core:  tidy.sh BUILD-TREE
set -eu
tree=$1

cmake -S . -B "$tree" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null
# The compiler's own omp.h, alone: clang brings the other headers of this kind itself.
mkdir -p build/tidy
cp "$(${CXX:-c++} -print-file-name=include/omp.h)" build/tidy/
find cpp/apps cpp/src -name '*.cpp' -print0 |
  xargs -0 -n 1 -P 2 clang-tidy --quiet -p "$tree" --extra-arg="-isystem$PWD/build/tidy"
