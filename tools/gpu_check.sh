#!/usr/bin/env bash
# Builds snowshed on a machine with a graphics card, measures it there and tests it, in less than
# eight minutes on 16 cores:
#   gpu_check.sh [FOLDER]              build and logs in FOLDER, by default build/gpu-check
#   gpu_check.sh --rehearse [FOLDER]   the same with small scenes on an emulated card, without limits
# Each step is independent of the others, and writes its result at once: speeds, means of stacks and
# the large panel into benchmarks/results/DATE-gpu-*.json, the outcome of each step into
# benchmarks/results/DATE-gpu-steps.txt (of a rehearsal into FOLDER). The exit code is 0 only if
# every step and every bound held on a card, or if a rehearsal ran. The machine needs a compiler,
# CMake, Python, the driver of the card, and NVIDIA's runtime compiler (of a CUDA toolkit, or by
# pip). Headers of Eigen, nlohmann-json and zlib come from the system or from .venv.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 2

rehearse=""
limit=470 # s
if [ "${1:-}" = "--rehearse" ]; then
  rehearse=yes
  limit=100000
  shift
fi
folder=$(mkdir -p "${1:-build/gpu-check}" && cd "${1:-build/gpu-check}" && pwd) || exit 2
records=benchmarks/results
[ -z "$rehearse" ] || records=$folder
cores=$(nproc)
python=python3
if [ -x .venv/bin/python ]; then
  python=.venv/bin/python
  PATH=$PWD/.venv/bin:$PATH
fi
outcomes=$records/$(date +%F)-gpu-steps.txt
failed=""

say() { printf '%s\n' "gpu_check: $*" | tee -a "$outcomes"; }
left() { echo $((limit - SECONDS)); }

# Runs a step with a time limit: NAME SECONDS COMMAND. Its output goes to FOLDER/NAME.log.
step() {
  local name=$1 seconds=$2 begin=$SECONDS
  shift 2
  [ -z "$rehearse" ] || seconds=$limit
  [ "$seconds" -le "$(left)" ] || seconds=$(left)
  if [ "$seconds" -lt 5 ]; then
    say "$name: NOT BEGUN: the time was over"
    failed="$failed $name"
    return 1
  fi
  if timeout --kill-after=20 "$seconds" "$@" > "$folder/$name.log" 2>&1; then
    say "$name: done in $((SECONDS - begin)) s"
  else
    say "$name: FAILED after $((SECONDS - begin)) s; the end of $folder/$name.log:"
    tail -n 15 "$folder/$name.log" | tee -a "$outcomes"
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
if [ -z "$rehearse$card" ]; then
  echo "gpu_check: NO CARD IS HERE (nvidia-smi lists none): nothing was done"
  echo "gpu_check: --rehearse tries all steps without one"
  exit 1
fi
find_compiler
: > "$outcomes"
say "$(date -Is), card: ${card:-NONE}; compiler: ${SNOWSHED_NVRTC:-where the system looks}; $cores cores"
[ -z "$rehearse" ] || say "a rehearsal: NOTHING IS MEASURED ON A CARD"

# --- build ---------------------------------------------------------------------------------------

# Tests need GoogleTest, which a machine without a network may not have.
tests=ON
timeout 40 cmake -S . -B "$folder/tree" -DCMAKE_BUILD_TYPE=Release -DSNOWSHED_BUILD_TESTS=ON \
  > "$folder/configure_tests.log" 2>&1 || {
  tests=OFF
  say "tests: LEFT OUT, because they cannot be built ($folder/configure_tests.log)"
}
step configure 40 cmake -S . -B "$folder/tree" -DCMAKE_BUILD_TYPE=Release \
  -DSNOWSHED_BUILD_TESTS=$tests || exit 1
program=$folder/tree/snowshed-run
step build 240 cmake --build "$folder/tree" -j "$cores" --target snowshed-run || exit 1
if [ -n "$rehearse" ]; then
  step build_emulated 240 cmake --build "$folder/tree" -j "$cores" --target snowshed_emulated_cuda
  export SNOWSHED_CUDA=$folder/tree/libsnowshed_emulated_cuda.so
  export XDG_CACHE_HOME=$folder/cache # no other program may take the code of a rehearsal
fi

# --- does it run, with the same bits each time? --------------------------------------------------

run_small() { # SCHEME NAME
  rm -rf "${folder:?}/$2" && "$program" "$folder/small-$1.json" -o "$folder/$2" --quiet
}
run_twice() { # SCHEME
  run_small "$1" first && run_small "$1" second &&
    cmp "$folder/first/particles/event_001.vtp" "$folder/second/particles/event_001.vtp"
}
export -f run_small run_twice
export folder program
$python -m tools.gpu_measure --write-small "$folder" || failed="$failed small_scenes"
for scheme in thesis objective; do
  step "same_bits_$scheme" 60 bash -c "run_twice $scheme"
done

# --- speed, the large panel, means of stacks -----------------------------------------------------

# Runs a step whose program writes its own record and keeps to its own time.
measure() {
  local name=$1 seconds=$2
  shift 2
  [ -z "$rehearse" ] || seconds=$limit
  [ "$seconds" -le "$(left)" ] || seconds=$(left)
  step "$name" $((seconds + 30)) "$python" -m "$@" --seconds "$seconds" --cores "$cores" \
    --records "$records"
  grep -h -e holds -e MISSED "$folder/$name.log" | tee -a "$outcomes"
}
if [ -n "$rehearse" ]; then
  measure speed 0 tools.gpu_measure "$program" "$folder/runs" --group rehearsal
  measure stacks 0 tools.gpu_stacks "$program" "$folder/stacks" --seeds 2 --only slab_against_board
else
  measure speed 120 tools.gpu_measure "$program" "$folder/runs" --group speed --card "$card"
  measure panel $(($(left) - 150)) tools.gpu_measure "$program" "$folder/runs" --group panel \
    --card "$card"
  measure stacks 60 tools.gpu_stacks "$program" "$folder/stacks"
fi

# --- faults of memory, and races between threads of the card, where NVIDIA's tool is installed ---

sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda*/bin/compute-sanitizer 2> /dev/null)
sanitizer=${sanitizer%%$'\n'*}
if [ -n "$card" ] && [ -n "$sanitizer" ]; then
  for tool in memcheck racecheck; do
    for scheme in thesis objective; do
      rm -rf "${folder:?}/$tool"
      step "${tool}_$scheme" 30 "$sanitizer" --tool "$tool" --error-exitcode 9 \
        "$program" "$folder/small-$scheme.json" -o "$folder/$tool" --quiet
    done
  done
else
  say "memcheck, racecheck: LEFT OUT (no card, or no compute-sanitizer)"
fi

# --- tests, which need no card and so come last --------------------------------------------------

if [ "$tests" = ON ]; then
  step build_tests 240 cmake --build "$folder/tree" -j "$cores" --target snowshed_tests &&
    step tests 120 ctest --test-dir "$folder/tree" -j "$cores" --output-on-failure \
      -R 'Card|CudaDevice|RuntimeCompiler|MachineCode|EmbeddedSources|Gpu'
fi

if [ -n "$failed" ]; then
  say "FAILED:$failed ($SECONDS s in all)"
  exit 1
fi
if [ -n "$rehearse" ]; then
  say "rehearsed in $SECONDS s; NOTHING WAS MEASURED ON A CARD"
else
  say "everything held ($SECONDS s in all)"
fi
