#!/bin/sh
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# peers_auc.sh BENCH_FOLDER [FRAMES] [ROUNDS] [THREADS] [FLAGS]
#
# Times the AUC over all frame pairs beside scripts of numpy and, where Python has it, torch in float64:
# the same poses, the same run, round by round, reading excluded. BENCH_FOLDER holds peers/ (the study of
# the shared folder). Prints each round, the ratios of the medians, the differences of the areas, and
# whether one thread gives the same bits as several. Then 20 000 frames, and with valgrind the
# instructions a pair. FLAGS are the compiler's, -march=native.
set -eu
bench=$(cd "$1" && pwd) frames=${2:-4763} rounds=${3:-3} threads=${4:-2} flags=${5:--march=native}
here=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python=$(command -p -v python3)
compile() {
  g++ -O3 -std=c++20 -ffp-contract=off "$1" -I "$here/include" -isystem /usr/include/eigen3 -pthread \
    -o "$2" "$here/tests/benchmark/time_auc.cpp"
}
cd "$work"
mkdir data
"$python" "$bench/peers/genposes.py"
compile "$flags" time_auc
poses=data/poses_4763.bin

field() { sed -n "s/.*$1 *\([0-9.e+-]*\).*/\1/p"; }
median() { sort -n "$1" | awk '{v[NR] = $1} END {print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2}'; }
peers=numpy
if "$python" -c "import torch" 2> /dev/null; then peers="numpy torch64"; else echo "torch: not here"; fi
for round in $(seq "$rounds"); do
  for again in 1 2 3; do
    ./time_auc $poses "$frames" "$threads" | tee aib.last
    field total < aib.last >> aib.txt
  done
  for peer in $peers; do
    "$python" "$bench/peers/auc_peer.py" "$frames" "$peer" "$threads" | tee "$peer.last"
    field total < "$peer.last" >> "$peer.txt"
  done
done
ours=$(median aib.txt)
for peer in $peers; do
  median "$peer.txt" | awk -v a="$ours" -v peer="$peer" -v n="$frames" -v t="$threads" -v r="$rounds" \
    '{printf "%s / aib: %.0f (%d frames, %d threads, medians of %d)\n", peer, $1 / a, n, t, r}'
  for pair in "AUC(joint):AUC(vggt)" "AUC(min of marginals, paper formula):AUC(paper)"; do
    field "${pair%:*}" < "$peer.last" | awk -v a="$(field "${pair#*:}" < aib.last)" -v of="${pair#*:}" \
      '{d = $1 - a; printf "  %s differs by %.1e\n", of, d < 0 ? -d : d}'
  done
done
areas() { ./time_auc $poses "$frames" "$1" | sed 's/.*AUC(paper)/AUC(paper)/; s/rssMB [0-9.]*//'; }
[ "$(areas 1)" = "$(areas "$threads")" ] && echo "1 and $threads threads: the same digits"
"$python" - << 'END'
import numpy
poses = numpy.fromfile("data/poses_4763.bin").reshape(2, -1, 12)
more = numpy.tile(poses, (1, 5, 1))[:, :20000].copy()
more[:, :, 3::4] += numpy.arange(20000)[None, :, None] // 4763 * 0.01  # no two centres are one
more.tofile("data/more.bin")
END
./time_auc data/more.bin 20000 "$threads"

command -v valgrind > /dev/null || exit 0
compile -mavx2 time_auc  # without vector instructions that valgrind does not know
instructions() {
  valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null \
    ./time_auc $poses "$1" 1 vggt 2>&1 | sed -n 's/.*I *refs: *\([0-9,]*\).*/\1/p' | tr -d ,
}
a=$(instructions 1000) b=$(instructions 2000)
awk -v a="$a" -v b="$b" 'BEGIN {printf "instructions a pair: %.1f (AVX2, from 1000 to 2000 frames)\n", (b - a) / 1499500}'
