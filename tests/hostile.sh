#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Every file of the zoo through the whole shell under AddressSanitizer and UndefinedBehaviorSanitizer,
# with a table of what became of each; then made-up calls of every bound function. Builds a folder of
# its own, build-hostile/.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/setup.sh tests --only-packages
[ -f build-hostile/build.ninja ] || meson setup build-hostile -Dtests=enabled -Dlua=enabled \
  -Dbuildtype=debugoptimized -Db_sanitize=address,undefined -Db_lundef=false \
  -Dcpp_args="-fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS" >/dev/null
ninja -C build-hostile lua/aib-lua tests/io/test_io

build-hostile/tests/io/test_io
python3 tests/hostile/zoo.py ../shared build-hostile/lua/aib-lua --sanitized

shell=$PWD/build-hostile/lua/aib-lua script=$PWD/tests/fuzz/fuzz_calls.lua
away=$(mktemp -d)
trap 'rm -rf "$away"' EXIT
cd "$away"
ASAN_OPTIONS=detect_leaks=0:max_allocation_size_mb=1100:allocator_may_return_null=1:hard_rss_limit_mb=3000 \
  "$shell" "$script" 20000 1
