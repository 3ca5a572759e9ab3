#!/bin/sh
# Creates a virtual environment with pip:  make_venv.sh PYTHON FOLDER
# On Debian and Ubuntu, the part of `venv` that installs pip is a separate package.
set -eu
python=$1
venv=$2
here=$(dirname "$0")

usable() { "$venv/bin/python" -m pip --version > /dev/null 2>&1; }

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 9))' ||
  { echo "snowshed needs Python 3.9 or newer as '$python' (choose another: make PYTHON=...)" >&2; exit 1; }

usable && exit 0
"$python" -m venv --clear "$venv" > /dev/null 2>&1 && usable && exit 0

echo "python -m venv does not work here: trying virtualenv"
"$python" -m virtualenv --quiet --clear "$venv" 2> /dev/null && usable && exit 0
# Install to a folder of the build tree, since systems may forbid pip to change theirs.
"$python" -m pip --quiet install --target build/virtualenv virtualenv &&
  PYTHONPATH=build/virtualenv "$python" -m virtualenv --quiet --clear "$venv" && usable && exit 0

version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
sh "$here/install_package.sh" "python$version-venv" &&
  "$python" -m venv --clear "$venv" && usable && exit 0

echo "Cannot make a virtual environment in $venv: install python3-venv or virtualenv." >&2
exit 1
