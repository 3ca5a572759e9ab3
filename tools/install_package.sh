#!/bin/sh
# Installs a Debian or Ubuntu package if possible:  install_package.sh PACKAGE
set -eu

if ! command -v apt-get > /dev/null || [ "$(id -u)" -ne 0 ]; then
  echo "$1 is missing and cannot be installed from here (needs root and apt-get)." >&2
  exit 1
fi
echo "Installing the system package $1"
export DEBIAN_FRONTEND=noninteractive
install() { apt-get install --yes --quiet --no-install-recommends "$1" > /dev/null 2>&1; }
install "$1" || { apt-get update --quiet > /dev/null 2>&1 && install "$1"; } ||
  { echo "apt-get could not install $1." >&2; exit 1; }
