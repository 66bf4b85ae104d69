#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Builds and runs the tests:
#
#   tests/run.sh [--all | --ci] [NAME ...]
#
#   NAME    a test or a suite (pose, style, ...); without one: all
#   --all   installs the heavy tools too, so that nothing is skipped
#   --ci    the same, warnings are errors, and a skipped test is a failure
set -euo pipefail
cd "$(dirname "$0")/.."

level=tests
options=(-Dtests=enabled)
summary=()
names=()
for argument in "$@"; do
  case $argument in
    --all) level=ci ;;
    --ci) level=ci; options+=(-Dwerror=true); summary=(--no-skips) ;;
    -*) echo "usage: tests/run.sh [--all | --ci] [NAME ...]" >&2; exit 2 ;;
    *) names+=("$argument") ;;
  esac
done

examples/setup.sh "$level" "${options[@]}"

tests=()
if [ ${#names[@]} != 0 ]; then
  mapfile -t tests < <(python3 tests/support/select_tests.py build "${names[@]}")
  [ ${#tests[@]} != 0 ] || { echo "tests/run.sh: no test and no suite is called ${names[*]}" >&2; exit 2; }
fi

echo "tests: building for this machine's own instruction set (-Dsimd=native)"
log=build/meson-logs
rm -f $log/testlog.json
[ ${#tests[@]} != 0 ] || ninja -C build all meson-test-prereq || true  # what fails is told below
meson test -C build --timeout-multiplier 3 "${tests[@]}" >$log/run.txt 2>&1 || true
python3 tests/support/summary.py $log "${summary[@]}"
