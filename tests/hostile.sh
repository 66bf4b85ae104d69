#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# All that is done to aib with files and scripts of strangers, with the figures of it:
#
#   tests/hostile.sh [MINUTES]     MINUTES of fuzzing, 1 without; tests/fuzz.sh keeps the totals
#
# The collection of good and malformed files (the zoo) through the whole shell under AddressSanitizer
# and UndefinedBehaviorSanitizer and through the plain one within 1 GiB; made-up calls of every bound
# function under the sanitizers; injected faults; how the shell is linked; what must hold of metrics;
# numbers of threads, locales, instruction sets; made-up files. Builds build/ and build-hostile/,
# which takes a quarter of an hour.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/setup.sh tests
ninja -C build lua/aib-lua tests/io/test_io tests/stats/test_stats
# Clang takes half the time, where its runtime library is here.
compiler=g++
[ -z "$(find /usr/lib/llvm-*/lib/clang -name 'libclang_rt.asan-x86_64.a' 2>/dev/null)" ] || compiler=clang++
[ -f build-hostile/build.ninja ] || CXX=$compiler meson setup build-hostile -Dtests=enabled \
  -Dlua=enabled -Doptimization=1 -Ddebug=false -Db_sanitize=address,undefined -Db_lundef=false \
  -Dcpp_args="-fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS" >/dev/null
ninja -C build-hostile lua/aib-lua tests/io/test_io

said=$(mktemp -d)
trap 'rm -rf "$said"' EXIT
failed=0 table=
# part NAME FIGURES COMMAND ...: runs a command; its last line with FIGURES goes into the table.
part() {
  local outcome=passed
  printf '\n== %s\n' "$1"
  "${@:3}" 2>&1 | tee "$said/part" || outcome=FAILED failed=$((failed + 1))
  table+="| $1 | $(grep -E "$2" "$said/part" | tail -n 1 | sed 's/^\[doctest\]//; s/ *|/,/g; s/ \+/ /g; s/^ //' || true) | $outcome |
"
}

properties() {
  local file
  for file in tests/properties/test_*.lua; do $plain "$file" || return; done | tee /dev/stderr |
    awk '/ seeded cases$/ { n += $1 } END { print n " seeded cases in all" }'
}

# Made-up calls, in an empty folder: they write files.
calls() (
  shell=$PWD/build-hostile/lua/aib-lua script=$PWD/tests/fuzz/fuzz_calls.lua
  away=$(mktemp -d)
  trap 'rm -rf "$away"' EXIT
  cd "$away"
  AIB_FUZZ_SMALL=1 ASAN_OPTIONS=detect_leaks=0:max_allocation_size_mb=1100:hard_rss_limit_mb=3000 \
    "$shell" "$script" 20000 1
)

plain=build/lua/aib-lua careful=build-hostile/lua/aib-lua
cases='test cases:' passed='[0-9]+ passed'
part "readers of every format, sanitizers" "$cases" build-hostile/tests/io/test_io
part "the zoo, sanitizers" '^[0-9]+ files:' python3 tests/hostile/zoo.py ../shared $careful --sanitized
part "the zoo within 1 GiB" '^[0-9]+ files:' python3 tests/hostile/zoo.py ../shared $plain
part "damaged folders, sanitizers" 'damaged folders' python3 tests/hostile/folders.py . $careful --rounds 5 --sanitized
part "damaged folders" 'damaged folders' python3 tests/hostile/folders.py . $plain --rounds 60
part "made-up calls, sanitizers" ' calls of ' calls
part "injected faults" 'in all$' python3 tests/hostile/faults.py . $plain
part "scripts that try to get out" "$passed" $plain tests/lua/test_sandbox.lua
part "threads and locales" "$passed" python3 tests/hostile/variants.py $plain build/tests/io/test_io build/tests/stats/test_stats
part "instruction sets, compilers, ThreadSanitizer" "$passed" python3 tests/instruction_sets/compare_bits.py .
part "how the shell is linked" "$passed" python3 tests/hostile/hardening.py $plain
part "what holds of every metric" 'in all$' properties
part "made-up files" "$passed" tests/fuzz.sh "${1:-1}"
part "made-up files, all runs so far" ' in all' tests/fuzz.sh --totals

printf '\n| what | figures | outcome |\n|---|---|---|\n%s\n%d parts failed\n' "$table" "$failed"
[ "$failed" = 0 ]
