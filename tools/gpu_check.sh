#!/usr/bin/env bash
# Builds snowshed on a machine with a graphics card, tests it there, and measures it, in less than
# eight minutes on 16 cores:
#   gpu_check.sh [FOLDER]          build and logs in FOLDER, by default build/gpu-check
#   gpu_check.sh --rehearse [FOLDER]   the same on the processor, with small scenes, without a card
# The last lines are the verdicts, and benchmarks/results/DATE-gpu.json has the numbers. The exit
# code is 0 only if every test and every bound held on a card, or if a rehearsal ran. The machine
# needs a compiler, CMake, Python, the driver of the card, and NVIDIA's runtime compiler (of a CUDA
# toolkit, or by pip). Headers of Eigen, nlohmann-json and zlib come from the system or from .venv.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 2

rehearse=""
if [ "${1:-}" = "--rehearse" ]; then
  rehearse="--rehearse"
  shift
fi
folder=${1:-build/gpu-check}
cores=$(nproc)
python=python3
if [ -x .venv/bin/python ]; then
  python=.venv/bin/python
  PATH=$PWD/.venv/bin:$PATH
fi
mkdir -p "$folder"
failed=""

say() { printf '%s\n' "gpu_check: $*"; }

# Runs a step with a time limit: NAME SECONDS COMMAND. Its output goes to FOLDER/NAME.log.
step() {
  local name=$1 seconds=$2 begin=$SECONDS
  shift 2
  if timeout "$seconds" "$@" > "$folder/$name.log" 2>&1; then
    say "$name: done in $((SECONDS - begin)) s"
  else
    say "$name: FAILED after $((SECONDS - begin)) s; the end of $folder/$name.log:"
    tail -n 15 "$folder/$name.log"
    failed="$failed $name"
    return 1
  fi
}

# The compiler of an installed CUDA toolkit, unless a package of Python or the caller has one.
find_compiler() {
  local library
  [ -z "${SNOWSHED_NVRTC:-}" ] || return 0
  for library in .venv/lib/python3*/site-packages/nvidia/*/lib/libnvrtc.so.1[23] \
    /usr/local/cuda*/lib64/libnvrtc.so.1[23] /usr/local/cuda*/targets/*/lib/libnvrtc.so.1[23]; do
    if [ -e "$library" ]; then
      export SNOWSHED_NVRTC=$PWD/$library
      [ "${library#/}" = "$library" ] || SNOWSHED_NVRTC=$library
      return 0
    fi
  done
}

card=$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2> /dev/null | head -n 1)
find_compiler
say "card: ${card:-none}; compiler: ${SNOWSHED_NVRTC:-where the system looks}; $cores cores"

# Tests need GoogleTest, which a machine without a network may not have.
options=(-DCMAKE_BUILD_TYPE=Release -DSNOWSHED_BUILD_TESTS=ON)
step configure 60 cmake -S . -B "$folder/tree" "${options[@]}" || {
  options[1]=-DSNOWSHED_BUILD_TESTS=OFF
  say "without GoogleTest; the tests are left out"
  step configure_program 60 cmake -S . -B "$folder/tree" "${options[@]}" || exit 1
}
step build 180 cmake --build "$folder/tree" -j "$cores" --target snowshed-run || exit 1
if [ "${options[1]}" = -DSNOWSHED_BUILD_TESTS=ON ]; then
  step build_tests 240 cmake --build "$folder/tree" -j "$cores" --target snowshed_tests &&
    step tests 90 ctest --test-dir "$folder/tree" -j "$cores" --output-on-failure \
      -R 'Card|CudaDevice|RuntimeCompiler|MachineCode|EmbeddedSources|Gpu'
fi

# Faults of memory and races between threads of the card, where NVIDIA's tool is installed.
sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda*/bin/compute-sanitizer 2> /dev/null)
sanitizer=${sanitizer%%$'\n'*}
if [ -n "$card" ] && [ -n "$sanitizer" ]; then
  $python tools/gpu_measure.py --write-small "$folder/small.json"
  for tool in memcheck racecheck; do
    rm -rf "${folder:?}/$tool"
    step "$tool" 40 "$sanitizer" --tool "$tool" --error-exitcode 9 \
      "$folder/tree/snowshed-run" "$folder/small.json" -o "$folder/$tool" --quiet
  done
else
  say "memcheck, racecheck: left out (no card, or no compute-sanitizer)"
fi

$python tools/gpu_measure.py "$folder/tree/snowshed-run" "$folder/runs" ${rehearse:+"$rehearse"} \
  --card "$card" --cores "$cores" --seconds $((470 - SECONDS)) --failed "$failed" || failed="$failed measurements"

if [ -n "$failed" ]; then
  say "FAILED:$failed ($SECONDS s in all)"
  exit 1
fi
if [ -n "$rehearse" ]; then
  say "rehearsed in $SECONDS s; NOTHING WAS MEASURED ON A CARD"
else
  say "everything held ($SECONDS s in all)"
fi
