# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Prints what each umbrella header costs a program that includes it, beside Eigen alone.

usage: compile_times.py SOURCE_ROOT     Seconds of the processor, without code generation
"""

import os
import pathlib
import resource
import shlex
import subprocess
import sys

COMPILER = shlex.split(os.environ.get("CXX", "c++"))


def seconds(flags, header):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [*COMPILER, "-std=c++20", "-fsyntax-only", *flags, "-include", header, "-x", "c++", "/dev/null"]
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(root):
    eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True)
    flags = [f"-I{root}/include", *eigen.stdout.split()]
    umbrellas = sorted(p.name for p in pathlib.Path(root, "include/aib").glob("*.hpp"))
    for header in ["Eigen/Dense", *(f"aib/{name}" for name in umbrellas)]:
        print(f"{header:<20} {seconds(flags, header):5.1f} s", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
