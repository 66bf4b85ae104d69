# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Holds the C++ sources against .clang-format, or formats them.

usage: format.py SOURCE_ROOT [--write]

The version counts: others break lines elsewhere.
"""

import pathlib
import shutil
import subprocess
import sys

VERSION = 14


def clang_format():
    for name in (f"clang-format-{VERSION}", "clang-format"):
        if shutil.which(name):
            version = subprocess.run([name, "--version"], capture_output=True, text=True).stdout
            if f"version {VERSION}." in version:
                return name
    return None


def sources(root):
    folders = ("include", "lua", "examples", "tests")
    return [p for f in folders for s in ("*.hpp", "*.cpp") for p in sorted(pathlib.Path(root, f).rglob(s))]


def main(root, *flags):
    program = clang_format()
    if not program:
        print(f"SKIPPED: format: clang-format {VERSION} is not here")
        return 77
    mode = ["-i"] if "--write" in flags else ["--dry-run", "-Werror", "--ferror-limit=3"]
    return subprocess.run([program, *mode, *sources(root)]).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
