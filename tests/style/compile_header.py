# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Compiles one header alone, all warnings as errors, and writes what the compiler says to a report.

usage: compile_header.py COMPILER BUILD_FOLDER HEADER REPORT DEPFILE

An empty report is a header that compiles. Flags are those the tests are built with. A header whose
library is not here is skipped.
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
    command = next(c["command"] for c in commands if c["file"].endswith("test_error.cpp"))
    flags = [f for f in shlex.split(command) if re.match(r"-(I|isystem|D|std=|W|f|m|pthread)", f)]
    flags += ["-Wextra", "-Wpedantic", "-Werror", "-Wno-unknown-warning-option"]
    return [*flags, "-fdiagnostics-color=never"]


def main(compiler, build_folder, header, report, depfile):
    command = [compiler, *flags_of_tests(build_folder), "-fsyntax-only", "-MD", "-MF", depfile]
    command += ["-MT", report, "-x", "c++", "-include", header, "/dev/null"]
    run = subprocess.run(command, cwd=build_folder, capture_output=True, text=True)
    absent = ABSENT.search(run.stderr)
    if absent:
        text = f"SKIPPED: {header}: {absent[1]} is not here\n"
    else:
        text = "" if run.returncode == 0 else f"{shlex.join(command)}\n{run.stderr}"
    pathlib.Path(report).write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
