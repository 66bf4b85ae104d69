# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Holds the headers against the floors of the house: includes go strictly down.

usage: floors.py SOURCE_ROOT

A header includes its own folder and the floors below; of two folders on one floor only mesh
includes cloud. Each header is listed (sorted) in include/meson.build and starts as all do.
"""

import pathlib
import re
import sys

FLOORS = [
    ["core"],
    ["math", "stats", "raster", "search"],
    ["depth", "pose", "cloud", "mesh"],
    ["align", "sample", "survey", "render", "io"],
    ["report", "stream"],
    ["umbrella"],
]
FLOOR_OF = {folder: floor for floor, folders in enumerate(FLOORS) for folder in folders}
ALLOWED = {("mesh", "cloud"), ("umbrella", "umbrella")}
HEAD = """\
// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once
"""


def folder_of(header):
    """`cloud` of `aib/cloud/compare.hpp`, `umbrella` of `aib/cloud.hpp`."""
    parts = pathlib.PurePosixPath(header).parts
    return parts[1] if len(parts) > 2 else "umbrella"


def may_include(includer, included):
    a, b = folder_of(includer), folder_of(included)
    if "umbrella" in (a, b):
        # The umbrella of a folder holds that folder; aib.hpp holds the umbrellas.
        return a == "umbrella" and (includer == "aib/aib.hpp" or b == pathlib.PurePath(includer).stem)
    return a == b or (a, b) in ALLOWED or FLOOR_OF[a] > FLOOR_OF[b]


def faults_of(header, text, known):
    if folder_of(header) not in FLOOR_OF:
        yield f"{header}: the folder is on no floor"
        return
    if not text.startswith(HEAD):
        yield f"{header}:1: does not start with the SPDX lines and #pragma once"
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*(["<])(.+?)[">]', line)
        if not match:
            continue
        if match[1] == '"':
            yield f"{header}:{number}: include <aib/...>, found \"{match[2]}\""
        elif match[2].startswith("aib/"):
            if match[2] not in known:
                yield f"{header}:{number}: {match[2]} does not exist"
            elif not may_include(header, match[2]):
                yield f"{header}:{number}: may not include {match[2]} (floors)"


def list_faults(root, known):
    listed = re.findall(r"^  '(aib/.+\.hpp)',$", (root / "include/meson.build").read_text(), re.MULTILINE)
    yield from (f"{h}: not in the list of include/meson.build" for h in sorted(known - set(listed)))
    yield from (f"{h}: in include/meson.build, but not here" for h in sorted(set(listed) - known))
    if listed != sorted(listed):
        first = next(a for a, b in zip(listed, sorted(listed)) if a != b)
        yield f"include/meson.build: the list is not sorted, see {first}"


def main(root):
    root = pathlib.Path(root)
    headers = {p.relative_to(root / "include").as_posix(): p for p in (root / "include").rglob("*.hpp")}
    if not headers:
        sys.exit("no header found")
    faults = {h: list(faults_of(h, p.read_text(), headers.keys())) for h, p in sorted(headers.items())}
    faults["include/meson.build"] = list(list_faults(root, headers.keys()))
    for messages in faults.values():
        for message in messages:
            print(message)
    n_failed = sum(bool(messages) for messages in faults.values())
    print(f"{len(faults) - n_failed} passed, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
