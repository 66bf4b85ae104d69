#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# From a fresh clone to a scored benchmark: installs what is missing, builds aib-lua and scores the
# reconstructions in examples/data the way the paper does.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/setup.sh shell
echo "quickstart: building aib-lua for this machine's own instruction set (-Dsimd=native)"
ninja -C build lua/aib-lua
build/lua/aib-lua examples/protocols/asset_inspection.lua examples/data --json build/quickstart.json \
  --html build/quickstart.html

cat <<'END'

Where the errors are, in charts, frames and 3-D: build/quickstart.html, which a browser opens from disk
Every number with its convention and options: build/quickstart.json
Your own scenes: build/lua/aib-lua examples/protocols/asset_inspection.lua --help
Line by line:    build/lua/aib-lua -i    and the scripts in examples/lua, in their order
END
