# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Prints the tests that are called, or belong to a suite that is called, as one of the names.

usage: select_tests.py BUILD_FOLDER NAME ...
"""

import json
import pathlib
import sys


def main(build_folder, *names):
    tests = json.loads(pathlib.Path(build_folder, "meson-info", "intro-tests.json").read_text())
    for test in tests:
        suites = {suite.partition(":")[2] or suite for suite in test["suite"]}
        if suites.union([test["name"]]).intersection(names):
            print(test["name"])


if __name__ == "__main__":
    main(*sys.argv[1:])
