#!/bin/sh
# Fuzzes each target of a build tree for the given time:  fuzz.sh TREE SECONDS
# Inputs that reach new code are kept in TREE/corpus, failing inputs in TREE/failures. Without
# libFuzzer the targets only replay the seeds.
set -eu
tree=$1
seconds=$2
targets="scene stl obj ply npy asc labels film checkpoint"
# Limits on the memory of a target, on the size of an allocation, and on the time of an input.
limits="-rss_limit_mb=1024 -malloc_limit_mb=512 -timeout=20"
export ASAN_OPTIONS=quarantine_size_mb=16
# Each input passes through a file, which is fastest in memory.
test ! -w /dev/shm || export TMPDIR=/dev/shm

"$tree/cpp/fuzz/fuzz_seeds" "$tree/seeds"
failed=""
for target in $targets; do
  program="$tree/cpp/fuzz/fuzz_$target"
  log="$tree/$target.log"
  mkdir -p "$tree/corpus/$target" "$tree/failures"
  if "$program" -help=1 2>&1 | grep -q max_total_time; then
    "$program" $limits -max_total_time="$seconds" -print_final_stats=1 -dict="$tree/seeds/$target.dict" \
      -artifact_prefix="$tree/failures/$target-" "$tree/corpus/$target" "$tree/seeds/$target" \
      > "$log" 2>&1 || failed="$failed $target"
    echo "$target: $(grep -c . "$log") lines in $log;" \
      "$(sed -n 's/stat::number_of_executed_units: *//p' "$log") inputs," \
      "$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1) edges of code reached"
  else
    "$program" "$tree/seeds/$target" > "$log" 2>&1 || failed="$failed $target"
    echo "$target: $(tail -1 "$log"), seeds only"
  fi
done
for target in $failed; do
  echo "--- $target failed:"
  grep -n -m 1 -A 25 -E 'ERROR: |runtime error|terminate called' "$tree/$target.log" || tail "$tree/$target.log"
  ls "$tree/failures/$target-"* 2> /dev/null || true
done
test -z "$failed"
