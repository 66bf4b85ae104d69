#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Gives every reader made-up files under AddressSanitizer and UndefinedBehaviorSanitizer:
#
#   tests/fuzz.sh MINUTES [READER ...]
#
#   MINUTES   in all, shared by the readers (a fraction is fine)
#   READER    depth.exr, mesh.ply, ...; without one: all
#
# Builds build-fuzz/ with clang and libFuzzer. Seeds are the bundled benchmark's files, and those of
# the zoo where it is. What was found stays in build-fuzz/findings/, the corpus in build-fuzz/corpus/.
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

readers=("$@")
[ ${#readers[@]} != 0 ] || mapfile -t readers < <($program 2>/dev/null)
seconds=$(python3 -c "print(max(1, int(60 * $minutes / ${#readers[@]})))")
echo "fuzz: ${#readers[@]} readers, $seconds s each"

# Seeds by the extension of the file that a reader is given.
seeds_of() {
  local extension=.${1#*.}
  case $1 in
    colmap.text) extension=.txt ;;
    colmap.*) extension=.bin ;;
    poses.opensfm) extension=.json ;;
  esac
  find examples/data ../shared/golden/zoo -name "*$extension" -size -64k 2>/dev/null | sort | awk 'NR % 7 == 1' | head -n 60
}

trap 'rm -rf /dev/shm/aib-fuzz-*' EXIT  # a finding leaves the file that it was read from
failed=0
for reader in "${readers[@]}"; do
  corpus=build-fuzz/corpus/$reader
  if [ ! -d "$corpus" ]; then
    mkdir -p "$corpus"
    while read -r seed; do cp "$seed" "$corpus/$(echo "$seed" | tr '/.' '__')"; done < <(seeds_of "$reader")
  fi
  log=build-fuzz/$reader.log
  status=0
  AIB_READER=$reader AIB_MODEL=examples/data/methods/glomap/crane/sparse/3 \
    UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=0 \
    $program "$corpus" -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=1100 -artifact_prefix="build-fuzz/findings/$reader-" -print_final_stats=1 \
    >"$log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  coverage=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 | cut -d ' ' -f 2)
  printf '%-16s %9s runs  coverage %5s  %s\n' "$reader" "${runs:-?}" "${coverage:-?}" \
    "$([ $status = 0 ] && echo 'nothing found' || echo "FOUND: see $log")"
  [ $status = 0 ] || failed=$((failed + 1))
done
echo "$((${#readers[@]} - failed)) passed, $failed failed"
[ $failed = 0 ]
