#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Every file of the zoo under AddressSanitizer and UndefinedBehaviorSanitizer, and a table of what
# became of each. Builds a folder of its own, build-hostile/.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/setup.sh tests --only-packages
[ -f build-hostile/build.ninja ] || meson setup build-hostile -Dtests=enabled -Dlua=enabled \
  -Dbuildtype=debugoptimized -Db_sanitize=address,undefined -Db_lundef=false \
  -Dcpp_args="-fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS" >/dev/null
ninja -C build-hostile lua/aib-lua tests/io/test_io

shared=../shared
build-hostile/tests/io/test_io
python3 tests/hostile/zoo.py "$shared" build-hostile/lua/aib-lua --sanitized
