#!/bin/sh
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# peers_depth.sh [FRAMES] [ROUNDS] [THREADS]
#
# Times aib beside numpy (float64) and, where they are here, OpenCV, tinyexr and OpenEXR, on 1080p
# frames in ZIP EXR files that it makes: the kernel, the decoder on one thread, the whole pipeline. Round by round
# in one run; prints the medians and their ratios.
set -eu
frames=${1:-8} rounds=${2:-5} threads=${3:-2}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
has() { echo "#include <$1>" | g++ -x c++ -E $openexr - > /dev/null 2>&1; }
openexr=$(pkg-config --silence-errors --cflags OpenEXR || true)
others=
has tinyexr.h && others="-DAIB_TEST_TINYEXR -ltinyexr"
has OpenEXR/ImfInputFile.h && others="$others -DAIB_TEST_OPENEXR $openexr $(pkg-config --libs OpenEXR)"
g++ -O3 -std=c++20 -ffp-contract=off -march=native -I "$here/../../include" -isystem /usr/include/eigen3 \
  -DAIB_WITH_EXR -DAIB_WITH_LIBDEFLATE -o "$work/time_depth" "$here/time_depth.cpp" $others -ldeflate -lz -pthread
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
for reader in tinyexr openexr; do
  grep -q "$reader" times || { echo "$reader: not here"; continue; }
  ours=$(median aib_aib) theirs=$(median aib_$reader)
  echo "decode ZIP, one thread: aib $ours ms, $reader $theirs ms, ratio $(ratio "$theirs" "$ours")"
done
ours=$(median aib_pipeline) theirs=$(median numpy_pipeline)
echo "pipeline, $threads threads: aib $ours frames/s, numpy $theirs frames/s, ratio $(ratio "$ours" "$theirs")"
