#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Runs the Lua and C++ blocks of a page and compares what they print with the text block after each.

  run_blocks.py PAGE --shell AIB_LUA --compile COMMAND...

PAGE is Markdown. A ```lua block runs in the shell, a ```cpp block is compiled with COMMAND; both run
in the folder of the page. A ```text block right after one is what it prints, to the letter. A
```console block is `$ aib-lua ...` and what that prints. A ```sh block is not run here: the commands
that it shows have tests of their own.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def run(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else f"exit {done.returncode}\n{done.stderr}"


def run_cpp(code, folder, compiler):
    with tempfile.TemporaryDirectory() as away:
        source, program = pathlib.Path(away, "block.cpp"), pathlib.Path(away, "block")
        source.write_text(code)
        built = subprocess.run(
            [*compiler, str(source), "-o", str(program)], capture_output=True, text=True, check=False
        )
        if built.returncode != 0:
            return built.stderr
        return run([str(program)], folder)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--shell", required=True)
    parser.add_argument("--compile", nargs=argparse.REMAINDER, required=True)
    options = parser.parse_args()

    blocks = BLOCK.findall(options.page.read_text())
    folder = options.page.resolve().parent
    shell = str(pathlib.Path(options.shell).resolve())
    eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True)
    compiler = [*options.compile, *eigen.stdout.split()]
    passed = failed = 0
    for (language, code), (after, expected) in zip(blocks, [*blocks[1:], ("", "")]):
        if language == "lua":
            printed = run([shell, "-e", code], folder)
        elif language == "cpp":
            printed = run_cpp(code, folder, compiler)
        elif language == "console":
            command, _, expected = code.partition("\n")
            after = "text"
            printed = run([shell, *shlex.split(command.removeprefix("$ aib-lua "))], folder)
        else:
            continue
        if after == "text" and printed == expected:
            passed += 1
        else:
            failed += 1
            print(f"--- {options.page.name}: this {language} block\n{code}--- printed\n{printed}--- expected\n{expected}")
    print(f"{passed} passed, {failed} failed")
    sys.exit(failed > 0 or passed == 0)


main()
