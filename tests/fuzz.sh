#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Gives every reader files under AddressSanitizer and UndefinedBehaviorSanitizer: first those of the
# zoo and those that were found before, then made-up ones:
#
#   tests/fuzz.sh MINUTES [READER ...]
#   tests/fuzz.sh --totals               what all runs came to, a line each reader
#
#   MINUTES   in all, shared by the readers (a fraction is fine), AIB_JOBS of which run at a time (1)
#   READER    depth.exr, mesh.ply, ...; without one: all. `calls` gives made-up values to every
#             function of the scripting interface, by build/lua/aib-lua
#
# Builds with clang and libFuzzer in build-fuzz/, or in the folder AIB_FUZZ, which keeps
#   corpus/     from which the next run goes on; at first the bundled benchmark's files, those in
#               tests/fuzz/seeds/, and those of the zoo where it is
#   seeds/      what tests/fuzz/seeds.py writes, in every run
#   findings/   which belong into tests/fuzz/regressions/, once mended
#   ledger      a line each run: reader, seconds of processor time, runs, edges, findings
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -ge 1 ] || { echo "usage: tests/fuzz.sh MINUTES|--totals [READER ...]" >&2; exit 2; }
minutes=$1
shift
work=${AIB_FUZZ:-build-fuzz}
jobs=${AIB_JOBS:-1}

totals() {
  [ -f "$work/ledger" ] || { echo "$work/ledger: no run so far"; return; }
  echo "target            minutes         runs   edges  findings"
  awk '{ s[$1] += $2; n[$1] += $3; edges[$1] = $4; found[$1] += $5 }
    END { for (t in n) printf "%-16s %8.1f %12d %7s %9d\n", t, s[t] / 60, n[t], edges[t], found[t] }' \
    "$work/ledger" | sort
  awk '{ targets[$1]; s += $2; n += $3; found += $5 } END {
      printf "%d targets, %.0f minutes of processor time, %d runs, %d findings in all\n", length(targets), s / 60, n, found
    }' "$work/ledger"
}
[ "$minutes" != --totals ] || { totals; exit; }

[ -n "$(find /usr/lib/llvm-*/lib/clang -name 'libclang_rt.fuzzer-x86_64.a' 2>/dev/null)" ] || {
  echo "SKIPPED: fuzzing: clang's runtime library (libclang-rt-14-dev) is not installed"
  exit 77
}
mkdir -p "$work/findings"
rm -rf "$work/seeds"
python3 tests/fuzz/seeds.py "$work/seeds"
program=$work/fuzz_readers
libraries=(eigen3 nanoflann zlib libdeflate spng libjpeg nlohmann_json pugixml)
if [ ! -x "$program" ] || [ -n "$(find include tests/fuzz -newer "$program" -name '*.[hc]pp' -print -quit)" ]; then
  # shellcheck disable=SC2046
  clang++ -std=c++20 -g1 -O1 -ffp-contract=off -fsanitize=fuzzer,address,undefined,float-cast-overflow \
    -fno-sanitize-recover=undefined,float-cast-overflow -D_GLIBCXX_ASSERTIONS -Iinclude \
    -DAIB_WITH_{EXR,NPZ,PNG,JPEG,JSON,XML,LIBDEFLATE} $(pkg-config --cflags "${libraries[@]}") \
    tests/fuzz/fuzz_readers.cpp -o "$program" $(pkg-config --libs "${libraries[@]}") -pthread
fi

aib_lua=${AIB_LUA:-build/lua/aib-lua}
mapfile -t targets < <("$program" 2>/dev/null)
[ ! -x "$aib_lua" ] || targets+=(calls)
readers=("${@:-"${targets[@]}"}")
for reader in "${readers[@]}"; do
  [[ " ${targets[*]} " == *" $reader "* ]] || {
    echo "fuzz: no target '$reader' (here: ${targets[*]})" >&2
    exit 2
  }
done
# Files that are read lie in memory where that is there.
away=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d)
trap 'rm -rf "$away"' EXIT
seconds=$(python3 -c "print(max(1, int(60 * $minutes * $jobs / ${#readers[@]})))")
echo "fuzz: ${#readers[@]} targets, $seconds s each, $jobs at a time"

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
  TMPDIR=$away AIB_READER=$1 AIB_MODEL=examples/data/methods/glomap/crane/sparse/3 \
    UBSAN_OPTIONS=print_stacktrace=1 \
    ASAN_OPTIONS=detect_leaks=0:hard_rss_limit_mb=2048:max_allocation_size_mb=1100:allocator_may_return_null=0 \
    "$program" "${@:2}" -timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=1100 \
    -artifact_prefix="$work/findings/$1-"
}

# Prints how many known files were read, or fails.
replay() {
  local known
  mapfile -t known < <(known_of "$1")
  [ ${#known[@]} = 0 ] || reader_run "$1" "${known[@]}" >>"$work/$1.log" 2>&1 || return 1
  echo ${#known[@]}
}

# conclude TARGET RUNS EDGES STATUS WHERE: the line of a run, and its place in the ledger, with the
# processor time of the target's subshell: a run that was stopped for a while counts for what it did.
conclude() {
  local spent
  times >"$work/$1.times"
  spent=$(awk 'FNR == 2 { split($1 "m" $2, t, /[ms]+/); printf "%.1f", 60 * (t[1] + t[3]) + t[2] + t[4] }' "$work/$1.times")
  echo "$1 $spent $2 $3 $(($4 != 0))" >>"$work/ledger"
  printf '%-16s %9s runs %7s edges  %s\n' "${@:1:3}" "$([ "$4" = 0 ] && echo 'nothing found' || echo "FOUND: see $5")"
  return "$4"
}

fuzz_reader() {
  local reader=$1 log=$work/$1.log corpus=$work/corpus/$1 seed known runs edges status=0
  : >"$log"
  known=$(replay "$reader") || status=1
  if [ ! -d "$corpus" ]; then
    mkdir -p "$corpus"
    while read -r seed; do cp "$seed" "$corpus/$(echo "$seed" | tr '/.' '__')"; done < <(seeds_of "$reader")
  fi
  local places=("$corpus")
  [ ! -d "$work/seeds/$reader" ] || places+=("$work/seeds/$reader")
  [ $status != 0 ] || reader_run "$reader" "${places[@]}" -max_total_time="$seconds" -max_len=65536 \
    -print_final_stats=1 >>"$log" 2>&1 || status=$?
  [ $status != 72 ] || status=0  # somebody interrupted it: that is no finding
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  edges=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 | tr -dc 0-9)
  conclude "$reader" $((${runs:-0} + ${known:-0})) "${edges:--}" $status "$log"
}

fuzz_calls() {
  local script=$PWD/tests/fuzz/fuzz_calls.lua log program first seed stop_at status=0
  log=$(realpath "$work")/calls.log
  program=$(realpath "$aib_lua")
  first=$(awk '$1 == "calls" { n += $3 } END { print n / 5000 }' "$work/ledger" 2>/dev/null || true)
  seed=${first:=0}
  stop_at=$(($(date +%s) + seconds))
  : >"$log"
  while [ $status = 0 ] && { [ "$seed" = "$first" ] || [ "$(date +%s)" -lt $stop_at ]; }; do
    seed=$((seed + 1))
    (cd "$away" && ulimit -v 4000000 && AIB_FUZZ_TRACE=1 timeout 120 "$program" "$script" 5000 $seed) >>"$log" 2>"$log.last" || status=$?
  done
  conclude calls $((5000 * (seed - first))) - $status "$log, seed $seed"
}

fuzz() {
  case $1 in
    calls) fuzz_calls ;;
    *) fuzz_reader "$1" ;;
  esac
}

failed=0 running=0
for reader in "${readers[@]}"; do
  if [ $running = "$jobs" ]; then
    wait -n || failed=$((failed + 1))
    running=$((running - 1))
  fi
  (fuzz "$reader" || exit 1) &
  running=$((running + 1))
done
for ((; running > 0; --running)); do
  wait -n || failed=$((failed + 1))
done
echo "$((${#readers[@]} - failed)) passed, $failed failed"
[ $failed = 0 ]
