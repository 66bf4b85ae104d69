#!/bin/sh
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# peers_depth.sh [FRAMES] [ROUNDS] [THREADS]
#
# Times aib beside numpy (float64) and, where it is here, OpenCV and tinyexr, on 1080p frames in ZIP
# EXR files that it makes: the kernel, the decoder on one thread, the whole pipeline. Round by round
# in one run; prints the medians and their ratios.
set -eu
frames=${1:-8} rounds=${2:-5} threads=${3:-2}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tinyexr=
echo '#include <tinyexr.h>' | g++ -x c++ -E - > /dev/null 2>&1 && tinyexr="-DAIB_TEST_TINYEXR -ltinyexr"
g++ -O3 -std=c++20 -ffp-contract=off -march=native -I "$here/../../include" -isystem /usr/include/eigen3 \
  -DAIB_WITH_EXR -DAIB_WITH_LIBDEFLATE -o "$work/time_depth" "$here/time_depth.cpp" $tinyexr -ldeflate -lz -pthread
python=$(command -p -v python3)
cd "$work"
./time_depth make . "$frames"
for round in $(seq "$rounds"); do
  { ./time_depth kernel . && ./time_depth decode . && ./time_depth pipeline . "$frames" "$threads"; } |
    sed 's/^/aib_/' >> times
  "$python" "$here/peers_depth.py" . "$frames" | sed 's/^/numpy_/' >> times
done
median() { sed -n "s/^$1 //p" times | sort -n | awk '{v[NR] = $1} END {print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2}'; }
ratio() { awk -v a="$1" -v b="$2" 'BEGIN {printf "%.2f", a / b}'; }
grep value times | sort -u
for what in srmse all; do
  ours=$(median aib_$what) theirs=$(median numpy_$what)
  echo "$what: aib $ours ms, numpy $theirs ms, ratio $(ratio "$theirs" "$ours")"
done
if grep -q tinyexr times; then
  ours=$(median aib_aib) theirs=$(median aib_tinyexr)
  echo "decode ZIP: aib $ours ms, tinyexr $theirs ms, ratio $(ratio "$theirs" "$ours")"
fi
ours=$(median aib_pipeline) theirs=$(median numpy_pipeline)
echo "pipeline, $threads threads: aib $ours frames/s, numpy $theirs frames/s, ratio $(ratio "$ours" "$theirs")"
