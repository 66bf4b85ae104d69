# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""How the shell is linked: at any address, relocations read-only, no stack that is run, calls and stacks checked.

usage: hardening.py AIB_LUA
"""

import subprocess
import sys


def printed(option, program):
    return subprocess.run(["readelf", "-W", option, program], capture_output=True, text=True, check=True).stdout


def main(program):
    header, segments, dynamic, symbols = (printed(o, program) for o in ("-h", "-l", "-d", "--dyn-syms"))
    stack = next(line for line in segments.splitlines() if "GNU_STACK" in line)
    checks = {
        "position-independent": "Position-Independent" in header or "PIE" in dynamic,
        "relocations bound at the start": "BIND_NOW" in dynamic,
        "and read-only": "GNU_RELRO" in segments,
        "no stack that is run": "E" not in stack.split()[-2],
        "stacks checked": "__stack_chk_fail" in symbols,
        "library calls checked": "_chk@" in symbols.replace("__stack_chk_fail@", ""),
    }
    for what, holds in checks.items():
        print(f"{what:<32}{'yes' if holds else 'NO'}")
    print(f"{sum(checks.values())} passed, {len(checks) - sum(checks.values())} failed")
    return not all(checks.values())


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
