#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The same bits from every instruction set and compiler.

usage: compare_bits.py SOURCE_ROOT
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

INSTRUCTION_SETS = {"plain": ["-DAIB_PLAIN"], "sse2": [], "native": ["-march=native"]}


def eigen_flags():
    found = subprocess.run(["pkg-config", "--cflags", "eigen3", "nanoflann"], capture_output=True, text=True)
    return found.stdout.split()


def printed(root, folder, name, compiler, flags):
    """What the program prints; None where this processor cannot run it."""
    program = pathlib.Path(folder, name.replace(" ", "_"))
    command = [compiler, "-std=c++20", "-O1", "-ffp-contract=off", "-pthread", f"-I{root / 'include'}", *flags, *eigen_flags()]
    subprocess.run([*command, root / "tests/instruction_sets/bits.cpp", "-o", program], check=True)
    run = subprocess.run([program], capture_output=True, text=True)
    return None if run.returncode == -4 else run.stdout  # SIGILL


def variants(root):
    for name, flags in INSTRUCTION_SETS.items():
        yield f"g++ {name}", "g++", flags
    if shutil.which("clang++"):
        yield "clang++ native", "clang++", INSTRUCTION_SETS["native"]


def main(root):
    root = pathlib.Path(root)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        jobs = {name: pool.submit(printed, root, folder, name, *rest) for name, *rest in variants(root)}
        outputs = {name: job.result() for name, job in jobs.items()}
    expected = outputs["g++ plain"]
    failed = 0
    for name, output in outputs.items():
        if output is None:
            print(f"SKIPPED: {name}: not on this processor")
        elif output != expected or len(output.splitlines()) < 20:
            failed += 1
            print(f"{name} differs from g++ plain:")
            pairs = zip(output.splitlines(), expected.splitlines())
            print("\n".join(f"  {ours}, {theirs}" for ours, theirs in pairs if ours != theirs))
    print(f"{sum(o is not None for o in outputs.values()) - failed} passed, {failed} failed")
    return failed > 0


sys.exit(main(*sys.argv[1:]))
