# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Reads every file of the zoo, each in a process of its own, and prints a table: format x outcome.

usage: zoo.py SHARED AIB_LUA [--sanitized]

A file is read or refused with a sentence that names it, within ten seconds of processor time, a
minute in all, and 1 GiB of addresses; a build with sanitizers has caps of its own instead. What is said to be not supported has a column
of its own. Values are compared by tests/io/test_zoo.cpp.
"""

import collections
import concurrent.futures
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys

SECONDS = 10
GIBIBYTE = 1 << 30
READ_LUA = pathlib.Path(__file__).with_name("read.lua")
SANITIZER = {
    "ASAN_OPTIONS": "hard_rss_limit_mb=1500:max_allocation_size_mb=1100:exitcode=99:detect_leaks=0",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1:exitcode=99",
}
ALLOWED = {
    "read": {"read", "unsupported"},
    "fail": {"refused", "unsupported"},
    "either": {"read", "refused", "unsupported"},
    "unsupported_ok": {"read", "refused", "unsupported"},
}

# A fuzzer's file whose list of channels claims 800 MB: OpenEXR overlooks it, aib refuses it.
STRICTER = {"openexr-tests__comp_bad_pos_bounds_pxr24.exr"}


def limit(is_sanitized):
    seconds = SECONDS * (10 if is_sanitized else 1)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    if not is_sanitized:
        resource.setrlimit(resource.RLIMIT_AS, (GIBIBYTE, GIBIBYTE))


def outcome_of(status, text, path):
    if status == -signal.SIGXCPU:
        return "hung"
    if status < 0 or status in (99, 134, 139):
        return "crashed"
    if status == 0:
        return "read"
    if status == 3 and "not supported" in text:
        return "unsupported"
    if status == 3:
        return "refused" if path.name in text or path.parent.name in text else "nameless"
    return "failed"  # a fault of ours that was caught


def models_of(path):
    """A folder of the zoo may hold one model twice, in bin/ and txt/."""
    folders = [path / name for name in ("bin", "txt") if (path / name).is_dir()]
    return folders or [path]


def try_one(aib_lua, is_sanitized, format_name, path):
    """(outcome, what was printed)"""
    environment = {**os.environ, "MALLOC_ARENA_MAX": "1", **(SANITIZER if is_sanitized else {})}
    try:
        run = subprocess.run(
            [aib_lua, READ_LUA, format_name, path],
            capture_output=True,
            timeout=6 * SECONDS * (10 if is_sanitized else 1),
            env=environment,
            preexec_fn=lambda: limit(is_sanitized),
        )
    except subprocess.TimeoutExpired:
        return "hung", ""
    text = (run.stdout + run.stderr).decode(errors="replace")
    return outcome_of(run.returncode, text, path), text


def main(shared, aib_lua, *flags):
    golden = pathlib.Path(shared, "golden")
    if not (golden / "manifest.json").exists():
        print("SKIPPED: zoo: the shared folder is not here")
        return 77
    tries = [
        (entry["format"].split()[0], "fail" if path.name in STRICTER else entry["must"], path)
        for entry in json.loads((golden / "manifest.json").read_text())["zoo"]
        for path in models_of(golden / entry["file"])
    ]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(
            lambda t: try_one(aib_lua, "--sanitized" in flags, t[0], t[2]),
            tries,
        )
        results = list(results)

    table = collections.defaultdict(collections.Counter)
    n_failed = 0
    for (format_name, must, path), (outcome, text) in zip(tries, results):
        table[format_name][outcome] += 1
        if outcome not in ALLOWED[must]:
            n_failed += 1
            print(f"{path.relative_to(golden)}: must be {must}, was {outcome}\n  {text.strip()[-2000:]}")

    columns = ["read", "unsupported", "refused", "nameless", "failed", "hung", "crashed"]
    print(f"{'format':<17}" + "".join(f"{column:>12}" for column in columns))
    for format_name in sorted(table):
        print(f"{format_name:<17}" + "".join(f"{table[format_name][column]:>12}" for column in columns))
    total = sum(table.values(), collections.Counter())
    print(f"{'all':<17}" + "".join(f"{total[column]:>12}" for column in columns))
    crashed = sum(total[column] for column in columns[3:])
    print(f"{len(tries)} files: {total['read']} read, {total['unsupported']} not supported, {total['refused']} refused, "
          f"{crashed} crashed or hung")
    print(f"{len(tries) - n_failed} passed, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
