#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Runs the examples in the project's folder and compares what they print with the file beside each.

  run_examples.py ROOT COMMAND... -- EXAMPLE...       an example is an argument of the command
  run_examples.py ROOT -- EXAMPLE=PROGRAM...          or a program of its own

What EXAMPLE.lua or EXAMPLE.cpp prints stands in EXAMPLE.output; with the environment variable
AIB_WRITE_OUTPUT it is written there.
"""
import os
import pathlib
import subprocess
import sys


def printed_by(command, root):
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else f"exit {done.returncode}\n{done.stderr}"


def main(root, *arguments):
    middle = arguments.index("--")
    command, examples = [str(pathlib.Path(a).resolve()) for a in arguments[:middle]], arguments[middle + 1 :]
    passed = failed = 0
    for example in examples:
        source, _, program = example.partition("=")
        printed = printed_by([program] if program else [*command, source], root)
        expected = pathlib.Path(source).with_suffix(".output")
        if "AIB_WRITE_OUTPUT" in os.environ:
            expected.write_text(printed)
        if expected.is_file() and printed == expected.read_text():
            passed += 1
        else:
            failed += 1
            print(f"--- {source} printed\n{printed}--- and not what {expected.name} holds")
    print(f"{passed} passed, {failed} failed")
    return failed > 0 or passed == 0


sys.exit(main(*sys.argv[1:]))
