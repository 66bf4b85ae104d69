#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Runs the blocks of a page and compares what they print with the text block after each.

  run_blocks.py PAGE --root ROOT --shell AIB_LUA --compile COMMAND...

PAGE is Markdown. A ```lua block runs in the shell, a ```cpp block is compiled with COMMAND, a
```python block runs where numpy and matplotlib are, all in the folder ROOT. A ```text block right
after one is what it prints, to the letter. A ```console block is `$ aib-lua ...` and what that
prints. A ```sh block is not run here: the commands that it shows have tests of their own. With the
environment variable AIB_WRITE_OUTPUT what is printed is written to the page.
"""
import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

BLOCK = re.compile(
    r"^```(?P<language>lua|cpp|python|console)\n(?P<code>.*?)^```\n(?P<after>\n```text\n(?P<expected>.*?)^```\n)?",
    re.MULTILINE | re.DOTALL,
)


class Runner:
    def __init__(self, options):
        self.root = options.root
        self.shell = options.shell.resolve()
        self.compiler = options.compile
        self.environment = {**os.environ, "PATH": f"{self.shell.parent}:{os.environ['PATH']}"}

    def run(self, command):
        done = subprocess.run(
            command, cwd=self.root, env=self.environment, capture_output=True, text=True, check=False
        )
        return done.stdout if done.returncode == 0 else f"exit {done.returncode}\n{done.stderr}"

    def lua(self, code):
        return self.run([self.shell, "-e", code])

    def console(self, command):
        return self.run([self.shell, *shlex.split(command.removeprefix("$ aib-lua "))])

    def python(self, code):
        return self.run([python_with_numpy(), "-c", code])

    def cpp(self, code):
        eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True)
        with tempfile.TemporaryDirectory() as away:
            source, program = pathlib.Path(away, "block.cpp"), pathlib.Path(away, "block")
            source.write_text(code)
            built = subprocess.run(
                [*self.compiler, *eigen.stdout.split(), str(source), "-o", str(program)],
                capture_output=True, text=True, check=False,
            )
            return built.stderr if built.returncode != 0 else self.run([program])


def python_with_numpy():
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import numpy, matplotlib"], capture_output=True).returncode == 0:
            return python
    return None


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--shell", type=pathlib.Path, required=True)
    parser.add_argument("--compile", nargs=argparse.REMAINDER, required=True)
    options = parser.parse_args()

    runner = Runner(options)
    counts = {"passed": 0, "failed": 0, "skipped": 0}

    def checked(block):
        language, code, expected = block["language"], block["code"], block["expected"]
        if language == "python" and python_with_numpy() is None:
            counts["skipped"] += 1
            return block[0]
        if language == "console":
            code, _, expected = code.partition("\n")
        printed = getattr(runner, language)(code)
        fits = printed == expected
        counts["passed" if fits else "failed"] += 1
        if not fits:
            print(f"--- {options.page.name}: this {language} block\n{code}\n--- printed\n{printed}--- expected\n{expected}")
        if language == "console":
            return f"```console\n{code}\n{printed}```\n"
        return f"```{language}\n{code}```\n\n```text\n{printed}```\n"

    written = BLOCK.sub(checked, options.page.read_text())
    if "AIB_WRITE_OUTPUT" in os.environ:
        options.page.write_text(written)
    if counts["skipped"]:
        print("SKIPPED: Python blocks: numpy and matplotlib are not installed")
    print(f"{counts['passed']} passed, {counts['failed']} failed")
    if counts["failed"] == 0 and counts["passed"] == 0:
        sys.exit(77 if counts["skipped"] else 1)
    sys.exit(counts["failed"] > 0)


main()
