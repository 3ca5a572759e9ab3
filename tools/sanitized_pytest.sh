#!/bin/sh
# Runs the Python tests with the extension and the executable of a sanitized build tree:
#   sanitized_pytest.sh TREE VENV RUNTIMES [PYTEST ARGUMENT...]
# The interpreter itself is not instrumented, so the sanitizers' RUNTIMES ("asan ubsan") are loaded
# ahead of it, and the C++ library with them, whose exceptions they watch.
set -eu
tree=$(realpath "$1")
venv=$(realpath "$2")
runtimes=$3
shift 3

# An environment whose `import snowshed` finds the tree's extension and links to the Python files,
# and all other packages in VENV. Path files there count for nothing, so the installed snowshed
# stays out.
packages='import sysconfig; print(sysconfig.get_path("purelib"))'
"$venv/bin/python" -m venv --without-pip --clear "$tree/venv"
site=$("$tree/venv/bin/python" -c "$packages")
"$venv/bin/python" -c "$packages" > "$site/packages.pth"
cp -rs "$PWD/python/snowshed" "$site/"
ln -s "$tree"/_core.*.so "$site/snowshed/"
ln -s "$tree/snowshed-run" "$tree/venv/bin/"

preload=""
for library in $runtimes stdc++; do
  preload="$preload $(${CXX:-c++} -print-file-name="lib$library.so")"
done
# What the interpreter keeps until its end is no leak of ours.
ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD="$preload" "$tree/venv/bin/python" -m pytest "$@"
