# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""What it costs to start aib-lua, beside plain Lua, and its size: start_up.py AIB_LUA

Times are printed, not judged: what is judged is the size, and that no module in Lua is loaded before
it is asked for.
"""

import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

MOST_BYTES = 6 << 20


def modules(program):
    """Modules written in Lua that are loaded before any code runs."""
    code = "for name in pairs(package.loaded) do if name:find '^aib%.' and name ~= 'aib.shell' then print(name) end end"
    return subprocess.run([program, "-e", code], capture_output=True, text=True, check=True).stdout.split()


def milliseconds(program):
    begin = time.perf_counter()
    subprocess.run([program, "-e", ""], check=True)
    return 1000 * (time.perf_counter() - begin)


def stripped_bytes(program):
    with tempfile.NamedTemporaryFile() as copy:
        subprocess.run(["strip", "-o", copy.name, program], check=True)
        return pathlib.Path(copy.name).stat().st_size


def main(aib_lua):
    size = stripped_bytes(aib_lua)
    print(f"stripped: {size / (1 << 20):.2f} MiB (at most {MOST_BYTES >> 20})")
    failed = size > MOST_BYTES
    loaded = modules(aib_lua)
    print(f"modules that nobody asked for: {' '.join(loaded) or 'none'}")
    failed |= bool(loaded)
    lua = shutil.which("lua5.4") or shutil.which("lua")
    pairs = [(milliseconds(aib_lua), milliseconds(lua) if lua else 0) for _ in range(21)]
    ours, theirs = (statistics.median(side) for side in zip(*pairs))
    print(f"start: {ours:.1f} ms" + (f", plain Lua {theirs:.1f} ms: {(ours - 3) / theirs:.2f} times and 3 ms" if lua else ""))
    print(f"{1 - failed} passed, {int(failed)} failed")
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
