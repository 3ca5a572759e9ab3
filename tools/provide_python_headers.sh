#!/bin/sh
# Installs the headers of a Python unless they are there:  provide_python_headers.sh PYTHON
set -eu
folder=$("$1" -c 'import sysconfig; print(sysconfig.get_path("include"))')
version=$("$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])')

sh "$(dirname "$0")/provide_header.sh" Python.h "python$version-dev" "-I$folder" ||
  { echo "Python.h is not in $folder: install python3-dev (Debian) or python3-devel (Fedora)." >&2
    exit 1; }
