#!/bin/sh
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# peers_cloud.sh BENCH_FOLDER [ROUNDS] [THREADS] [SIZE...]
#
# Times aib beside plain nanoflann (OpenMP) and, where Python has it, Open3D: the same files, the same
# run, round by round, reading excluded; ratios of medians. SIZE is 100000, 1000000, 5000000 (default),
# 5000000s (in spatial order, needs numpy), 20000000. Then what aib costs: growth, far strays, SSE2
# against AVX2, bytes of the index, reading, voxels. BENCH_FOLDER holds gen.cpp, common.h and peers/
# (the study of the shared folder). Instructions are held by a test, tests/search/instructions.py.
set -eu
bench=$(realpath "$1") rounds=${2:-5} threads=${3:-2}
shift $(($# < 3 ? $# : 3))
sizes=${*:-100000 1000000 5000000 5000000s}
here=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags="-O3 -std=c++20 -ffp-contract=off"
g++ $flags -I "$bench" -fopenmp -o "$work/gen" "$bench/gen.cpp"
g++ $flags -march=native -fopenmp -I "$bench" -o "$work/nano" "$bench/peers/nano.cpp"
for isa in native x86-64-v3 x86-64; do
  g++ $flags -march=$isa -I "$here/include" -isystem /usr/include/eigen3 -pthread \
    -o "$work/time_$isa" "$here/tests/benchmark/time_cloud.cpp"
done
cd "$work"
mkdir data
export OMP_WAIT_POLICY=passive OMP_NUM_THREADS="$threads"
python=$(command -p -v python3 || true)
has() { [ -n "$python" ] && "$python" -c "import $1" 2> /dev/null; }

# make SIZE: data/R_SIZE.ply and G_SIZE.ply
make() {
  [ ! -e "data/R_$1.ply" ] || return 0
  case $1 in
    *s) make "${1%s}" && "$python" "$bench/peers/coherent.py" "${1%s}" ;;
    *) ./gen data "$1" "$1" > gen.log 2>&1 ;;
  esac
}
# field NAME: the number behind a name in what is read
field() { sed -n "s/.*$1 \([0-9.]*\).*/\1/p"; }
median() { sort -n "$1" | awk '{v[NR] = $1} END {print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2}'; }
ratio() { awk -v a="$1" -v b="$2" -v f="${3:-1}" 'BEGIN {printf "%.2f", a / b / f}'; }
# time_aib FILE ISA SIZE [STRAYS]: appends the seconds to FILE
time_aib() { "./time_$2" "data/R_$3.ply" "data/G_$3.ply" "$threads" "${4:-0}" | tee line | field total >> "$1"; }

for size in $sizes; do
  case $size in *s) has numpy || { echo "$size: no numpy"; continue; } ;; esac
  make "$size"
  for round in $(seq "$rounds"); do
    time_aib "aib_$size" native "$size" && cp line "line_$size"
    ./nano "$size" plain "$threads" 10 1 | field total >> "nano_$size"
    if has open3d; then "$python" "$bench/peers/peer_o3d.py" "$size" | field total >> "open3d_$size"; fi
  done
  for peer in nano open3d; do
    [ -s "${peer}_$size" ] || continue
    echo "$size: $peer / aib $(ratio "$(median "${peer}_$size")" "$(median "aib_$size")")" \
      "($(median "${peer}_$size") s, $(median "aib_$size") s)"
  done
  echo "$size: $(cat "line_$size")"
done

make 1000000
for round in $(seq "$rounds"); do
  time_aib plain native 1000000
  time_aib strays native 1000000 20
  time_aib avx2 x86-64-v3 1000000
  time_aib sse2 x86-64 1000000
done
echo "20 far strays: $(ratio "$(median strays)" "$(median plain)") of the time without"
echo "SSE2 / AVX2: $(ratio "$(median sse2)" "$(median avx2)")"
if [ -s aib_1000000 ] && [ -s aib_20000000 ]; then
  echo "growth a point, 1M to 20M: $(ratio "$(median aib_20000000)" "$(median aib_1000000)" 20)"
fi
