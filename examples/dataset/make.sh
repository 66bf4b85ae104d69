#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Makes a benchmark folder of generated scenes: plans the flight, renders, adds sensor noise, casts the ground truth, packs.
#
#   examples/dataset/make.sh SCENE --scale tiny|small|paper [--out FOLDER] [--soiling LEVELS] [--samples N]
#
#   SCENE       office, crane, bridge or all; several makes share a folder
#   --scale     tiny: 24 frames of 320 x 180; small: 140 to 250 of 960 x 540; paper: 4763, 642, 1074 of 1920 x 1080
#   --out       default build/dataset
#   --soiling   of the office's glass, with commas: very_low,low,medium,high; default: first and last, all at paper
#   --samples   rays a pixel at most; default 16, 64, 128 by scale (a denoiser is used where Blender has one)
#   --frames    START:STOP:STEP: render these alone and stop then, for several machines that share the folder
#
# Run again after a stop: what is there in full is kept. Then run_colmap.sh FOLDER, aib-lua asset_inspection FOLDER.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/find_aib_lua.sh"

usage() { sed -n '5,17s/^# \?//p' "$0" >&2; exit 2; }

scenes=() scale= out=$here/../../build/dataset soiling= samples= frames=
while [ $# != 0 ]; do
  case $1 in
    office|crane|bridge) scenes+=("$1") ;;
    all) scenes+=(office crane bridge) ;;
    --scale|--out|--soiling|--samples|--frames)
      [ $# -gt 1 ] || usage
      declare "${1#--}=$2"
      shift ;;
    *) usage ;;
  esac
  shift
done
[ ${#scenes[@]} != 0 ] || usage
case $scale in
  tiny) : "${samples:=16}" "${soiling:=very_low,high}" ;;
  small) : "${samples:=64}" "${soiling:=very_low,high}" ;;
  paper) : "${samples:=128}" "${soiling:=very_low,low,medium,high}" ;;
  *) usage ;;
esac
mkdir -p "$out"
out=$(cd "$out" && pwd)

plan() {  # a plan of another scale is not mixed with this one
  local gt=$out/gt/$1
  if [ -f "$gt/plan.json" ]; then
    grep -q "\"scale\": *\"$scale\"" "$gt/plan.json" && return
    echo "make: $gt is of another scale; use another --out" >&2
    exit 2
  fi
  "$aib_lua" "$here/plan.lua" "$1" "$scale" "$gt"
}

render() {  # render SCENE SOILING UNIT: pictures without noise into render/UNIT
  local began=$SECONDS log=$out/render/$3.log
  mkdir -p "$out/render"
  "$here/blender.sh" render --mesh "$out/gt/$1/mesh.ply" --transforms "$out/gt/$1/transforms.json" \
    --out "$out/render/$3" --soiling "$2" --samples "$samples" --frames "$frames" >"$log" 2>&1 ||
    { echo "make: rendering $3 failed:" >&2; tail -n 15 "$log" >&2; exit 1; }
  echo "make: $3: $(find "$out/render/$3/images" -name '*.png' | wc -l) pictures, $((SECONDS - began)) s"
}

for scene in "${scenes[@]}"; do
  plan "$scene"
  levels=very_low
  [ "$scene" != office ] || levels=${soiling//,/ }
  for level in $levels; do
    unit=$scene
    [ "$scene" != office ] || unit=office-$level
    render "$scene" "$level" "$unit"
    [ -n "$frames" ] || "$aib_lua" "$here/noise.lua" "$out/render/$unit/images" "$out/images/$unit"
  done
  [ -n "$frames" ] || "$aib_lua" "$here/truth.lua" "$out/gt/$scene"
done
[ -n "$frames" ] || "$aib_lua" "$here/pack.lua" "$out"
