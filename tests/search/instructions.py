# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Holds the search to half of the instructions of plain nanoflann, 100 000 points both ways.

usage: instructions.py PROGRAM

Times differ from machine to machine and from run to run, counts of instructions do not.
"""

import re
import shutil
import subprocess
import sys

MOST = 0.5


def run(program, what):
    """Instructions that a run takes, and what it printed."""
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    ran = subprocess.run([*command, program, what], capture_output=True, text=True, check=True)
    return int(re.search(r"I\s+refs:\s+([\d,]+)", ran.stderr)[1].replace(",", "")), ran.stdout.strip()


def main(program):
    if shutil.which("valgrind") is None:
        print("SKIPPED: instructions: valgrind is not installed")
        return 77
    nothing, _ = run(program, "none")
    ours, our_sum = run(program, "aib")
    theirs, their_sum = run(program, "nanoflann")
    ratio = (ours - nothing) / (theirs - nothing)
    print(f"{ours - nothing} / {theirs - nothing} instructions = {ratio:.3f}, at most {MOST}")
    if abs(float(our_sum) - float(their_sum)) > 1e-5 * float(their_sum):
        print(f"distances differ: {our_sum}, {their_sum}")
        return 1
    return 0 if ratio <= MOST else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
