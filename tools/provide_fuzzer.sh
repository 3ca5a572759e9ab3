#!/bin/sh
# Prints the name of a clang with libFuzzer, which fuzz targets need:  provide_fuzzer.sh
# Installs the system's packages if they are missing and can be installed.
set -eu
here=$(dirname "$0")
probe=$(mktemp -d)
trap 'rm -r "$probe"' EXIT
cat > "$probe/target.cpp" << 'END'
#include <cstddef>
extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, std::size_t) {
  return 0;
}
END

usable() {
  "$1" -fsanitize=fuzzer,address "$probe/target.cpp" -o "$probe/target" > /dev/null 2>&1
}
find_one() {
  for compiler in clang++ $(seq -f clang++-%.0f 25 -1 14); do
    usable "$compiler" && echo "$compiler" && exit 0
  done
  return 0
}

find_one
for package in clang libclang-rt-dev; do
  sh "$here/install_package.sh" "$package" >&2 || break
  find_one
done
echo "No clang with libFuzzer: install clang and libclang-rt-dev." >&2
exit 1
