# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Sums up a run of `meson test`: a line per suite, failures and skips in full, a verdict, and
which tests took longest.

usage: summary.py LOG_FOLDER [--no-skips]

What counts: the test cases of a doctest program; the `N passed, N failed` with which a script
closes; one, for a test that prints neither. A line with `SKIPPED: what: why` is a skip.
"""

import json
import pathlib
import re
import sys
from dataclasses import dataclass, field

DOCTEST = re.compile(r"\[doctest\] test cases:\s*\d+ \|\s*(\d+) passed \|\s*(\d+) failed")
SCRIPT = re.compile(r"^(\d+) passed, (\d+) failed", re.MULTILINE)
SKIP = re.compile(r"SKIPPED: (.*)")
# Expected numbers of other programs, which not every machine has; no fault of this one.
NOT_OURS = "the shared folder is not here"


@dataclass
class Tally:
    passed: int = 0
    failed: int = 0
    skips: list = field(default_factory=list)

    def __iadd__(self, other):
        self.passed += other.passed
        self.failed += other.failed
        self.skips += other.skips
        return self


def tally_of(test):
    output = test.get("stdout", "")
    skips = list(dict.fromkeys(SKIP.findall(output)))
    cases = DOCTEST.findall(output)
    counts = cases or SCRIPT.findall(output)[-1:]
    passed, failed = (sum(int(count[i]) for count in counts) for i in (0, 1))
    if cases:  # doctest knows no skips: the case passed
        passed = max(passed - len(skips), 0)
    if test["result"] == "SKIP":
        return Tally(skips=skips or [test["name"]])
    if test["result"] != "OK":
        return Tally(passed, max(failed, 1), skips)
    if not counts:
        passed = 1
    return Tally(passed, failed, skips)


def suite_of(test):
    suite, _, name = test["name"].rpartition(" / ")
    suite = suite.partition(":")[2] if ":" in suite else suite
    return suite if suite and suite != "aib" else name


def read_tests(log_folder):
    log = log_folder / "testlog.json"
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text(errors="replace").splitlines()]


def tail(text, n_lines=60):
    lines = text.rstrip().splitlines()
    cut = [f"... ({len(lines) - n_lines} lines above)"] if len(lines) > n_lines else []
    return "\n".join("  " + line for line in cut + lines[-n_lines:])


def slowest(tests, n=5):
    """The tests that took longest, for one line."""
    by_time = sorted(tests, key=lambda test: -test["duration"])[:n]
    return ", ".join(f"{test['name'].partition(':')[2]} {test['duration']:.0f} s" for test in by_time)


def main(log_folder, *flags):
    log_folder = pathlib.Path(log_folder)
    tests = read_tests(log_folder)
    total, suites = Tally(), {}
    for test in tests:
        tally = tally_of(test)
        suites.setdefault(suite_of(test), Tally()).__iadd__(tally)
        total += tally
        if tally.failed:
            print(f"FAILED {test['name']} ({test['result']}, exit code {test['returncode']})")
            print(tail(test.get("stdout", "") + test.get("stderr", "")))
    if not tests:
        print("FAILED build: no test was run")
        print(tail((log_folder / "run.txt").read_text(errors="replace")))
        total.failed = 1

    print(f"\n{'suite':<16} passed  failed  skipped")
    for suite, tally in suites.items():
        print(f"{suite:<16} {tally.passed:6}  {tally.failed:6}  {len(tally.skips):7}")
    if len(tests) > 1:
        print(f"longest: {slowest(tests)}")
    for skip in dict.fromkeys(total.skips):
        print(f"skipped: {skip}")
    if "--no-skips" in flags:
        total.failed += sum(NOT_OURS not in skip for skip in total.skips)
    print(f"{total.passed} passed, {total.failed} failed")
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
