#!/bin/sh
# Installs the package of a C++ header unless the compiler finds the header:
#   provide_header.sh HEADER PACKAGE [COMPILER FLAG...]
set -eu
header=$1
package=$2
shift 2

present() { echo "#include <$header>" | ${CXX:-c++} -std=c++17 "$@" -x c++ -E - > /dev/null 2>&1; }

present "$@" || { sh "$(dirname "$0")/install_package.sh" "$package" && present "$@"; }
