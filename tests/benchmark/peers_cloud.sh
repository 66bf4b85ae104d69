#!/bin/sh
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# peers_cloud.sh BENCH_FOLDER [POINTS] [ROUNDS] [THREADS]
#
# Times aib beside plain nanoflann (OpenMP) and, where Python has it, Open3D: the same files, the same
# run, round by round, reading excluded. BENCH_FOLDER holds gen.cpp, common.h and peers/ (the study of
# the shared folder). Prints each round and the ratios of the medians. With valgrind: the ratio of
# instructions on 100 000 points.
set -eu
bench=$1 points=${2:-1000000} rounds=${3:-5} threads=${4:-2}
here=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags="-O3 -std=c++20 -ffp-contract=off"
g++ $flags -I "$bench" -fopenmp -o "$work/gen" "$bench/gen.cpp"
g++ $flags -march=native -fopenmp -I "$bench" -o "$work/nano" "$bench/peers/nano.cpp"
g++ $flags -march=native -I "$here/include" -isystem /usr/include/eigen3 -pthread \
  -o "$work/time_cloud" "$here/tests/benchmark/time_cloud.cpp"
cd "$work"
mkdir data
./gen data "$points" T > gen.log 2>&1
export OMP_WAIT_POLICY=passive OMP_NUM_THREADS="$threads"
python=$(command -p -v python3 || true)
has_open3d=no
[ -n "$python" ] && "$python" -c "import open3d" 2> /dev/null && has_open3d=yes

total() { sed -n 's/.*total \([0-9.]*\).*/\1/p'; }
median() { sort -n "$1" | awk '{v[NR] = $1} END {print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2}'; }
for round in $(seq "$rounds"); do
  ./time_cloud data/R_T.ply data/G_T.ply "$threads" | tee last | total >> aib.txt
  cat last
  ./nano T plain "$threads" 10 1 | tee last | total >> nano.txt
  cat last
  [ $has_open3d = yes ] || continue
  "$python" "$bench/peers/peer_o3d.py" T | tee last | total >> open3d.txt
  cat last
done
ours=$(median aib.txt)
for peer in nano open3d; do
  [ -s $peer.txt ] || { echo "$peer: not here"; continue; }
  echo "$peer / aib: $(median $peer.txt | awk -v a="$ours" '{printf "%.2f", $1 / a}') ($points points, $threads threads, medians of $rounds)"
done

command -v valgrind > /dev/null || exit 0
./gen data 100000 S > gen.log 2>&1
instructions() {
  valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null "$@" 2>&1 |
    sed -n 's/.*I *refs: *\([0-9,]*\).*/\1/p' | tr -d ,
}
# Without vector instructions that valgrind does not know.
g++ $flags -mavx2 -I "$here/include" -isystem /usr/include/eigen3 -pthread \
  -o time_cloud "$here/tests/benchmark/time_cloud.cpp"
g++ $flags -mavx2 -fopenmp -I "$bench" -o nano "$bench/peers/nano.cpp"
a=$(instructions ./time_cloud data/R_S.ply data/G_S.ply 1)
b=$(instructions ./nano S plain 1 10 1)
echo "instructions aib / nano: $(awk -v a="$a" -v b="$b" 'BEGIN {printf "%.3f", a / b}') ($a / $b, 100 000 points)"
