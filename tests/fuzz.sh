#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Gives every reader files under AddressSanitizer and UndefinedBehaviorSanitizer: first those of the
# zoo and those that were found before, then made-up ones:
#
#   tests/fuzz.sh MINUTES [READER ...]
#
#   MINUTES   in all, shared by the readers (a fraction is fine)
#   READER    depth.exr, mesh.ply, ...; without one: all. `calls` gives made-up values to every
#             function of the scripting interface, by build/lua/aib-lua
#
# Builds build-fuzz/ with clang and libFuzzer. Seeds are the bundled benchmark's files, those in
# tests/fuzz/seeds/, and those of the zoo where it is. What was found stays in build-fuzz/findings/ (and belongs into
# tests/fuzz/regressions/, once mended), the corpus in build-fuzz/corpus/.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -ge 1 ] || { echo "usage: tests/fuzz.sh MINUTES [READER ...]" >&2; exit 2; }
minutes=$1
shift

[ -n "$(find /usr/lib/llvm-*/lib/clang -name 'libclang_rt.fuzzer-x86_64.a' 2>/dev/null)" ] || {
  echo "SKIPPED: fuzzing: clang's runtime library (libclang-rt-14-dev) is not installed"
  exit 77
}
mkdir -p build-fuzz/findings
program=build-fuzz/fuzz_readers
libraries=(eigen3 nanoflann zlib libdeflate spng libjpeg nlohmann_json pugixml)
if [ ! -x $program ] || [ -n "$(find include tests/fuzz -newer $program -name '*.[hc]pp' -print -quit)" ]; then
  # shellcheck disable=SC2046
  clang++ -std=c++20 -g1 -O1 -ffp-contract=off -fsanitize=fuzzer,address,undefined \
    -fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS -Iinclude \
    -DAIB_WITH_{EXR,NPZ,PNG,JPEG,JSON,XML,LIBDEFLATE} $(pkg-config --cflags "${libraries[@]}") \
    tests/fuzz/fuzz_readers.cpp -o $program $(pkg-config --libs "${libraries[@]}") -pthread
fi

aib_lua=${AIB_LUA:-build/lua/aib-lua}
readers=("$@")
if [ ${#readers[@]} = 0 ]; then
  mapfile -t readers < <($program 2>/dev/null)
  [ ! -x "$aib_lua" ] || readers+=(calls)
fi
seconds=$(python3 -c "print(max(1, int(60 * $minutes / ${#readers[@]})))")
echo "fuzz: ${#readers[@]} targets, $seconds s each"

# files_of READER FOLDER ...: files with the extension that the reader is given, or in a folder of that name.
files_of() {
  local extension=${1#*.}
  case $1 in
    colmap.text) extension=txt ;;
    colmap.*) extension=bin ;;
    poses.opensfm) extension=json ;;
  esac
  find "${@:2}" -type f '(' -iname "*.$extension" -o -ipath "*/$extension/*" ')' 2>/dev/null | sort
}

seeds_of() {
  files_of "$1" examples/data ../shared/golden/zoo |
    xargs -r -d '\n' sh -c 'find "$@" -size -64k' find | awk 'NR % 7 == 1' | head -n 60
  find tests/fuzz/seeds -name "$1-*" | sort
}

known_of() {
  files_of "$1" ../shared/golden/zoo
  find tests/fuzz/regressions -name "$1-*" 2>/dev/null | sort
}

# reader_run READER ARGUMENT ...
reader_run() {
  AIB_READER=$1 AIB_MODEL=examples/data/methods/glomap/crane/sparse/3 \
    UBSAN_OPTIONS=print_stacktrace=1 \
    ASAN_OPTIONS=detect_leaks=0:hard_rss_limit_mb=2048:max_allocation_size_mb=1100:allocator_may_return_null=0 \
    $program "${@:2}" -timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=1100 \
    -artifact_prefix="build-fuzz/findings/$1-"
}

# Prints how many known files were read, or fails.
replay() {
  local known
  mapfile -t known < <(known_of "$1")
  [ ${#known[@]} = 0 ] || reader_run "$1" "${known[@]}" >>"build-fuzz/$1.log" 2>&1 || return 1
  echo ${#known[@]}
}

fuzz_reader() {
  local reader=$1 log=build-fuzz/$1.log corpus=build-fuzz/corpus/$1 seed known runs coverage status=0
  : >"$log"
  known=$(replay "$reader") || status=1
  if [ ! -d "$corpus" ]; then
    mkdir -p "$corpus"
    while read -r seed; do cp "$seed" "$corpus/$(echo "$seed" | tr '/.' '__')"; done < <(seeds_of "$reader")
  fi
  [ $status != 0 ] || reader_run "$reader" "$corpus" -max_total_time="$seconds" -max_len=65536 \
    -print_final_stats=1 >>"$log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  coverage=$(grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -n 1 | tr -d 'a-z:')
  # shellcheck disable=SC2086
  printf '%-16s %5s known %9s runs  coverage %5s edges %6s features  %s\n' "$reader" "${known:-?}" "${runs:-?}" \
    ${coverage:-? ?} "$([ $status = 0 ] && echo 'nothing found' || echo "FOUND: see $log")"
  return $status
}

fuzz_calls() {
  local script log=$PWD/build-fuzz/calls.log program away end seed=0 status=0
  script=$PWD/tests/fuzz/fuzz_calls.lua
  program=$(realpath "$aib_lua")
  away=$(mktemp -d)
  end=$(($(date +%s) + seconds))
  : >"$log"
  while [ $status = 0 ] && { [ $seed = 0 ] || [ "$(date +%s)" -lt $end ]; }; do
    seed=$((seed + 1))
    (cd "$away" && ulimit -v 4000000 && AIB_FUZZ_TRACE=1 timeout 120 "$program" "$script" 5000 $seed) >>"$log" 2>"$log.last" || status=$?
  done
  rm -rf "$away"
  printf '%-16s %26s calls  %s\n' calls $((5000 * seed)) \
    "$([ $status = 0 ] && echo 'nothing found' || echo "FOUND: seed $seed, exit $status, see $log")"
  return $status
}

trap 'rm -rf /dev/shm/aib-fuzz-*' EXIT  # a finding leaves the file that it was read from
failed=0
for reader in "${readers[@]}"; do
  case $reader in
    calls) fuzz_calls || failed=$((failed + 1)) ;;
    *) fuzz_reader "$reader" || failed=$((failed + 1)) ;;
  esac
done
echo "$((${#readers[@]} - failed)) passed, $failed failed"
[ $failed = 0 ]
