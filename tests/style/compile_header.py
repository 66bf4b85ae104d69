# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Compiles one header alone, all warnings as errors, and writes what the compiler says to a report.

usage: compile_header.py COMPILER BUILD_FOLDER HEADER REPORT DEPFILE [PRELUDE]
       compile_header.py --prelude COMPILER BUILD_FOLDER HEADERS PRELUDE

An empty report is a header that compiles. Flags are those the tests are built with. A header whose
library is not here is skipped. A prelude is what clang has read beforehand.
"""

import json
import pathlib
import re
import shlex
import subprocess
import sys

ABSENT = re.compile(r"fatal error: '?(?!aib/)([\w./]+)'?(: No such file| file not found)")


def flags_of_tests(build_folder):
    commands = json.loads(pathlib.Path(build_folder, "compile_commands.json").read_text())
    command = next(c["command"] for c in commands if "test_core" in c["output"])
    flags = [f for f in shlex.split(command) if re.match(r"-(I|isystem|D|std=|W|f|m|pthread)", f)]
    flags += ["-Wextra", "-Wpedantic", "-Werror", "-Wno-unknown-warning-option"]
    return [*flags, "-fdiagnostics-color=never"]


def precompile(compiler, build_folder, headers, prelude):
    command = [compiler, *flags_of_tests(build_folder), "-x", "c++-header", headers, "-o", prelude]
    subprocess.run(command, cwd=build_folder, check=True)


def main(compiler, build_folder, header, report, depfile, prelude=None):
    command = [compiler, *flags_of_tests(build_folder), "-fsyntax-only", "-MD", "-MF", depfile]
    command += ["-include-pch", prelude] if prelude else []
    command += ["-MT", report, "-x", "c++", "-include", header, "/dev/null"]
    run = subprocess.run(command, cwd=build_folder, capture_output=True, text=True)
    absent = ABSENT.search(run.stderr)
    if absent:
        text = f"SKIPPED: {header}: {absent[1]} is not here\n"
    else:
        text = "" if run.returncode == 0 else f"{shlex.join(command)}\n{run.stderr}"
    pathlib.Path(report).write_text(text)


if __name__ == "__main__":
    if sys.argv[1] == "--prelude":
        precompile(*sys.argv[2:])
    else:
        main(*sys.argv[1:])
