#!/bin/sh
# Installs a wheel into a clean environment and tries it: check_wheel.sh PYTHON WHEEL
set -eu
python=$1
wheel=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$python" -m venv venv
started=$(date +%s)
venv/bin/pip --quiet --disable-pip-version-check install "$wheel"
echo "installed in $(($(date +%s) - started)) s"
unset LD_LIBRARY_PATH PYTHONPATH
venv/bin/python - <<'END'
import subprocess, sys, time
def taken(code):
    started = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True)
    return time.perf_counter() - started
print(f"import snowshed: {min(taken('import snowshed') for _ in range(5)):.3f} s")
END
venv/bin/snowshed self-test
venv/bin/snowshed panel --preset lab-50 --dim 2 --dx 0.02 --events 1 --quiet -o panel
venv/bin/snowshed-run panel/scene.json --quiet -o executable
venv/bin/snowshed slide --example --max-time 2 --quiet -o slide
venv/bin/snowshed grains example --quiet -o grains
ls panel/events.csv executable/run.json slide/slide.json grains/grains.json
echo "the wheel works"
