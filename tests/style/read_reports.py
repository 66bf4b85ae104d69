# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Reads the reports of compile_header.py: an empty one is a header that compiles alone."""

import pathlib
import sys


def main(*reports):
    if not reports:
        print("SKIPPED: headers alone: the compiler is not here")
        return 77
    texts = [pathlib.Path(report).read_text() for report in reports]
    skips = sorted({text for text in texts if text.startswith("SKIPPED")})
    faults = [text for text in texts if text and text not in skips]
    print("".join(skips), *faults, sep="\n")
    print(f"{len(texts) - len(faults)} passed, {len(faults)} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
