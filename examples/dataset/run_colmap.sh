#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Reconstructs the pictures of a benchmark folder with COLMAP and puts the result into it:
#
#   examples/dataset/run_colmap.sh FOLDER [UNIT ...] [--mapper incremental|global]
#
#   UNIT       a folder of FOLDER/images (office-high, crane, ...); default: all
#   --mapper   global is GLOMAP, part of COLMAP since 4.0
#
# COLMAP 3.8 and later; another than the one on PATH by COLMAP=/path/to/colmap. The recipe is the paper's: one pinhole
# camera, exhaustive matching, the mapper's own thresholds, dense stereo at 480 pixels. What this machine cannot do is
# done otherwise and said so in FOLDER/methods/METHOD/UNIT/run.json, with every command.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/find_aib_lua.sh"

colmap=${COLMAP:-colmap}
mapper=incremental
max_exhaustive=150  # pictures that are matched exhaustively without a graphics card
folder=
units=()
while [ $# != 0 ]; do
  case $1 in
    --mapper) mapper=$2; shift ;;
    -*) sed -n '5,14s/^# \?//p' "$0" >&2; exit 2 ;;
    *) if [ -z "$folder" ]; then folder=$1; else units+=("$1"); fi ;;
  esac
  shift
done
if [ ! -d "${folder:-}/images" ]; then
  echo "run_colmap: FOLDER with images expected, found '${folder:-}'" >&2
  exit 2
fi
command -v "$colmap" >/dev/null || { echo "run_colmap: $colmap is not here" >&2; exit 2; }
[ ${#units[@]} != 0 ] || mapfile -t units < <(cd "$folder/images" && printf '%s\n' *)

# What this COLMAP is: 4.x moved the options of features, CUDA is told by `colmap help`.
about=$("$colmap" help 2>&1 || true)
version=$(sed -n 's/^COLMAP \([0-9][0-9.]*\).*/\1/p' <<<"$about" | head -n 1)
has_cuda=yes
! grep -q "without CUDA" <<<"$about" || has_cuda=no
extraction=SiftExtraction matching=SiftMatching
if "$colmap" feature_extractor -h 2>&1 | grep -q "FeatureExtraction.use_gpu"; then
  extraction=FeatureExtraction matching=FeatureMatching
fi
use_gpu=$([ $has_cuda = yes ] && echo 1 || echo 0)
case $mapper in
  incremental) method=colmap name="COLMAP $version" ;;
  global)
    method=glomap name="GLOMAP (COLMAP $version)"
    if ! grep -q "global_mapper" <<<"$about"; then
      echo "run_colmap: COLMAP $version has no global_mapper; 4.0 and later have it" >&2
      exit 2
    fi ;;
  *) echo "run_colmap: --mapper incremental or global expected, found '$mapper'" >&2; exit 2 ;;
esac

deviations=() commands=()

deviate() {  # deviate WHAT PAPER HERE REASON
  deviations+=("    {\"what\": \"$1\", \"paper\": \"$2\", \"here\": \"$3\", \"reason\": \"$4\"}")
  echo "run_colmap: $1: $3 instead of $2 ($4)"
}

run() {  # run COMMAND OPTION ...: a step of COLMAP, its output goes to the log
  commands+=("    \"colmap ${*//$folder\//}\"")
  { echo "== colmap $*"; "$colmap" "$@"; } >>"$place/log.txt" 2>&1
}

must() {  # must COMMAND OPTION ...: as run; where it fails, so does this script
  run "$@" || { echo "run_colmap: colmap $1 failed:" >&2; tail -n 15 "$place/log.txt" >&2; exit 1; }
}

lines_of() {  # lines_of LINE ...: of a JSON list, with commas between
  printf '%s\n' "$@" | sed '$!s/$/,/'
}

write_facts() {
  {
    printf '{\n  "method": "%s",\n  "colmap": "%s",\n  "cuda": "%s",\n  "mapper": "%s",\n' \
      "$name" "$version" "$has_cuda" "$mapper"
    printf '  "deviations": [\n%s\n  ],\n' "$(lines_of "${deviations[@]}")"
    printf '  "commands": [\n%s\n  ]\n}\n' "$(lines_of "${commands[@]}")"
  } >"$place/run.json"
}

n_models() { find "$place/sparse" -mindepth 1 -maxdepth 1 -type d | wc -l; }

map_incrementally() {
  run mapper --database_path "$database" --image_path "$images" --output_path "$place/sparse" "$@" || true
}

sparse() {  # features, matches, models of $images into $place
  local n pairs
  n=$(find "$images" -name '*.png' | wc -l)
  database=$place/database.db
  rm -rf "$database" "$place/sparse" "$place/log.txt"
  mkdir -p "$place/sparse"
  must feature_extractor --database_path "$database" --image_path "$images" \
    --ImageReader.camera_model SIMPLE_PINHOLE --ImageReader.single_camera 1 --$extraction.use_gpu "$use_gpu"
  pairs=exhaustive
  if [ $has_cuda = no ] && [ "$n" -gt $max_exhaustive ]; then
    pairs=sequential
    deviate "matching" "exhaustive" "sequential, overlap 10, quadratic" "no CUDA, $n pictures"
  fi
  must ${pairs}_matcher --database_path "$database" --$matching.use_gpu "$use_gpu"
  if [ $mapper = global ]; then
    must global_mapper --database_path "$database" --image_path "$images" --output_path "$place/sparse"
    return
  fi
  map_incrementally
  if [ "$(n_models)" = 0 ]; then
    deviate "mapper thresholds" "COLMAP's own" "half the inliers, angles from 6 degrees" "no model with COLMAP's own"
    map_incrementally --Mapper.init_min_num_inliers 50 --Mapper.abs_pose_min_num_inliers 15 \
      --Mapper.init_min_tri_angle 6 --Mapper.min_num_matches 10
  fi
}

dense() {  # depth maps and their fusion, of the first model
  rm -rf "$place/dense"
  if [ $has_cuda = no ]; then
    deviate "dense stereo" "PatchMatch, photometric, 480 pixels" "none: sparse points are scored" "no CUDA"
    return
  fi
  must image_undistorter --image_path "$images" --input_path "$place/sparse/0" --output_path "$place/dense" \
    --max_image_size 480
  must patch_match_stereo --workspace_path "$place/dense" --PatchMatchStereo.geom_consistency 0
  must stereo_fusion --workspace_path "$place/dense" --input_type photometric --output_path "$place/dense/fused.ply"
}

for unit in "${units[@]}"; do
  images=$folder/images/$unit place=$folder/methods/$method/$unit
  [ -d "$images" ] || { echo "run_colmap: no pictures in $images" >&2; exit 2; }
  deviations=() commands=()
  began=$SECONDS
  mkdir -p "$place"
  sparse
  if [ "$(n_models)" != 0 ]; then dense; fi
  rm -f "$place/database.db"
  write_facts
  echo "run_colmap: $unit: $(n_models) models by $name in $((SECONDS - began)) s"
done
"$aib_lua" "$here/pack.lua" "$folder"
