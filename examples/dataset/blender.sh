#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Renders frames of a transforms.json, or exports a .blend file, without a display (blender/run.py has the options):
#
#   examples/dataset/blender.sh render --mesh mesh.ply --transforms transforms.json --out FOLDER --soiling low
#   examples/dataset/blender.sh mine.blend export --out FOLDER
#   examples/dataset/blender.sh mine.blend render --transforms FOLDER/transforms.json --out FOLDER
#
# Another Blender than the one on PATH: BLENDER=/path/to/blender. Exit code 1 where anything fails.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
blender=$(command -v "${BLENDER:-blender}") || { echo "blender.sh: Blender is not here (Debian: apt install blender)" >&2; exit 2; }
file=--factory-startup
case ${1:-} in *.blend) file=$1; shift ;; esac

# Blender finds its Python's modules beside the first python3 on PATH, which has to be the system's.
export PATH=$(dirname "$blender"):$PATH
"$blender" -b "$file" --python-exit-code 1 -P "$here/blender/run.py" -- "$@" 2>&1 |
  { grep --line-buffered -vE '^(Fra:|Saved: | Time: |Blender |Read blend|Error: Not freed|$)' || true; }
