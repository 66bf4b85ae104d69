#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The same bits from every instruction set, compiler and number of threads, and from the single header.

usage: compare_bits.py SOURCE_ROOT

That of the single header is built with ThreadSanitizer, which finds nothing.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

SANITIZED = ["-DAIB_SINGLE", "-fsanitize=thread", "-g1"]
VARIANTS = {
    "g++ plain": ("g++", ["-DAIB_PLAIN"], [1]),
    "g++ sse2": ("g++", [], [1]),
    "g++ native": ("g++", ["-march=native"], [1, 2, 5]),
    "g++ single header, sanitized": ("g++", SANITIZED, [5]),
    "clang++ native": ("clang++", ["-march=native"], [2]),
}


def eigen_flags():
    found = subprocess.run(["pkg-config", "--cflags", "eigen3", "nanoflann"], capture_output=True, text=True)
    return found.stdout.split()


def near_addresses():
    """The sanitizer's memory does not fit around addresses that the system draws too far apart."""
    words = ["setarch", "-R"]
    return words if shutil.which("setarch") and subprocess.run([*words, "true"], capture_output=True).returncode == 0 else []


def printed(root, folder, name, compiler, flags, threads):
    """(name, what the program prints) for each number of threads; None where this processor cannot run it."""
    program = pathlib.Path(folder, name.replace(" ", "_"))
    include = root / ("single_include" if "-DAIB_SINGLE" in flags else "include")
    command = [compiler, "-std=c++20", "-O1", "-ffp-contract=off", "-pthread", f"-I{include}", *flags, *eigen_flags()]
    subprocess.run([*command, root / "tests/instruction_sets/bits.cpp", "-o", program], check=True)
    for n in threads:
        run = subprocess.run([*(near_addresses() if flags == SANITIZED else []), program, str(n)], capture_output=True, text=True)
        if run.returncode not in (0, -4):
            print(run.stderr[-4000:])
        yield f"{name}, threads {n}", None if run.returncode == -4 else run.stdout if run.returncode == 0 else ""  # SIGILL


def main(root):
    root = pathlib.Path(root)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(lambda v: list(printed(root, folder, v[0], *v[1])), variant)
                for variant in VARIANTS.items() if shutil.which(variant[1][0])]
        outputs = dict(pair for job in jobs for pair in job.result())
    expected = outputs["g++ plain, threads 1"]
    failed = 0
    for name, output in outputs.items():
        if output is None:
            print(f"SKIPPED: {name}: not on this processor")
        elif output == expected and len(output.splitlines()) > 70:
            print(f"{name:<42}{len(output.splitlines()):>5} numbers, the same")
        else:
            failed += 1
            print(f"{name} differs from g++ plain:")
            pairs = zip(output.splitlines(), expected.splitlines())
            print("\n".join(f"  {ours}, {theirs}" for ours, theirs in pairs if ours != theirs))
    print(f"{sum(o is not None for o in outputs.values()) - failed} passed, {failed} failed")
    return failed > 0


sys.exit(main(*sys.argv[1:]))
