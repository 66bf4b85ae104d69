# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The same numbers for 1, 2 and 5 threads, and under a locale that writes a comma for the point.

usage: variants.py AIB_LUA [TEST_PROGRAM ...]

The locale is made here. The test programs, which read and write every text format, pass under it.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).with_name("numbers.lua")
SOURCES = pathlib.Path("/usr/share/i18n")


def make_locale(folder):
    """The name of a locale with a decimal comma in the folder; None where it cannot be made."""
    if not shutil.which("localedef") or not (SOURCES / "locales" / "de_DE").exists():
        return None
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True, check=False)
    return "de_DE.UTF-8" if made.returncode == 0 else None


def printed(aib_lua, folder, threads, locale=None):
    environment = {**os.environ, **({"LOCPATH": str(folder), "LC_ALL": locale} if locale else {})}
    with tempfile.TemporaryDirectory() as away:
        run = subprocess.run([aib_lua, "--threads", str(threads), SCRIPT, away, *([locale] if locale else [])],
                             capture_output=True, text=True, env=environment, check=False)
    if run.returncode != 0:
        print(run.stderr)
    return run.stdout


def differences(name, output, expected):
    if output == expected and len(output.splitlines()) > 400:
        print(f"{name:<22}{len(output.splitlines()):>6} values, the same")
        return 0
    print(f"{name} differs:")
    pairs = zip(output.splitlines(), expected.splitlines())
    print("\n".join([f"  {ours}, {theirs}" for ours, theirs in pairs if ours != theirs][:20]))
    return 1


def main(aib_lua, *programs):
    with tempfile.TemporaryDirectory() as folder:
        locale = make_locale(pathlib.Path(folder))
        expected = printed(aib_lua, folder, 1)
        failed = differences("1 thread, again", printed(aib_lua, folder, 1), expected)
        for threads in (2, 5):
            failed += differences(f"{threads} threads", printed(aib_lua, folder, threads), expected)
        if locale is None:
            print("SKIPPED: decimal commas: no localedef or no source of locales (Debian: locales)")
        else:
            failed += differences("decimal commas", printed(aib_lua, folder, 2, locale), expected)
            environment = {**os.environ, "LOCPATH": folder, "AIB_TEST_LOCALE": locale, "LANGUAGE": "en"}
            for program in programs:
                run = subprocess.run([program], capture_output=True, text=True, env=environment, check=False)
                name = pathlib.Path(program).name + ", commas"
                print(f"{name:<22}{run.stdout.strip().splitlines()[-2] if run.returncode == 0 else run.stdout}")
                failed += run.returncode != 0
    print(f"{4 + len(programs) - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
