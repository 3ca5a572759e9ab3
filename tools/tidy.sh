#!/bin/sh
# Runs clang-tidy on the core, in a separate build tree that compiles one source at a time.
set -eu
tree=build/tidy

cmake -S . -B "$tree" -DSNOWSHED_UNITY_BUILD=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null
find cpp/apps cpp/snowshed -name '*.cpp' -print0 |
  xargs -0 -n 1 -P 2 clang-tidy --quiet -p "$tree"
