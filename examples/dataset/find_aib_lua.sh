# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# For the scripts beside it: sets aib_lua to the shell that runs Lua scripts.
aib_lua=${AIB_LUA:-$here/../../build/lua/aib-lua}
[ -x "$aib_lua" ] || aib_lua=$(command -v aib-lua || true)
if [ -z "$aib_lua" ]; then
  echo "$(basename "$0"): aib-lua is not here: build it with examples/quickstart.sh, or say AIB_LUA=/path/to/aib-lua" >&2
  exit 2
fi
