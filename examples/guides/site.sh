#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Builds the documentation site with Doxygen, and follows every link:
#
#   examples/guides/site.sh AIB_LUA FOLDER
#
# The guides, the reference of the scripting interface (a page a module) and that of the library.
set -euo pipefail
[ $# = 2 ] || { echo "usage: examples/guides/site.sh AIB_LUA FOLDER" >&2; exit 2; }
command -v doxygen >/dev/null || { echo "SKIPPED: documentation site: doxygen is not installed"; exit 77; }
shell=$(realpath "$1")
mkdir -p "$2"
site=$(realpath "$2")
here=$(realpath "$(dirname "$0")")
root=$(realpath "$here/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Links to files that are no pages become plain words.
mkdir "$work/guides" "$work/lua"
for page in "$here"/*.md; do
  sed -E 's#\[([^]]*)\]\(\.\./[^)]*\)#\1#g' "$page" >"$work/guides/$(basename "$page")"
done
"$shell" "$here/reference.lua" "$work/lua"
{
  printf '\n## Reference\n\nThe scripting interface:\n\n'
  for page in "$work"/lua/*.md; do
    printf '* [%s](lua/%s)\n' "$(basename "$page" .md)" "$(basename "$page")"
  done
  printf '\nThe library: [namespaces](namespaces.html), [classes](annotated.html), [files](files.html).\n'
} >>"$work/guides/README.md"

cat >"$work/Doxyfile" <<CONFIG
PROJECT_NAME = aib
PROJECT_BRIEF = "Evaluation of 3D reconstructions"
INPUT = $work/guides $work/lua $root/include
USE_MDFILE_AS_MAINPAGE = $work/guides/README.md
IMAGE_PATH = $here
RECURSIVE = YES
STRIP_FROM_PATH = $root/include $work
FILE_PATTERNS = *.hpp *.md
EXCLUDE_SYMBOLS = detail *::detail *::frame_stack::*
EXTRACT_ALL = YES
MACRO_EXPANSION = YES
PREDEFINED = AIB_ISA=isa AIB_WITH_EXR AIB_WITH_NPZ AIB_WITH_PNG AIB_WITH_JPEG AIB_WITH_JSON AIB_WITH_XML
GENERATE_LATEX = NO
GENERATE_TREEVIEW = YES
HAVE_DOT = NO
HTML_OUTPUT = html
OUTPUT_DIRECTORY = $work
QUIET = YES
WARNINGS = NO
CONFIG
doxygen "$work/Doxyfile"
cp -r "$work/html/." "$site"
python3 "$here/check_links.py" "$site"
