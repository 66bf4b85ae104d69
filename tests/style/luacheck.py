# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Runs luacheck over every Lua file.

usage: luacheck.py SOURCE_ROOT
"""

import shutil
import subprocess
import sys


def main(root):
    if not shutil.which("luacheck"):
        print("SKIPPED: luacheck: luacheck is not here")
        return 77
    command = ["luacheck", "--quiet", "--no-color", "lua", "examples", "tests"]
    return subprocess.run(command, cwd=root).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
