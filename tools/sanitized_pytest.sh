#!/bin/sh
# Runs the Python tests with the extension and the executable of a sanitized build tree:
#   sanitized_pytest.sh TREE VENV RUNTIMES [PYTEST ARGUMENT...]
# The interpreter is not instrumented. The sanitizers' RUNTIMES ("asan ubsan") are therefore loaded
# before it, together with the C++ library, whose exceptions they intercept.
set -eu
tree=$(realpath "$1")
venv=$(realpath "$2")
runtimes=$3
shift 3

# Create an environment in which `import snowshed` finds the tree's extension beside links to the
# Python files. All other packages come from VENV. Python ignores path files there, so it does not
# find the snowshed installed in VENV.
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
# Leaks are not looked for, since the interpreter itself keeps much memory until its end.
ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD="$preload" "$tree/venv/bin/python" -m pytest "$@"
