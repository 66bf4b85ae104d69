# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Writes C++ that holds the text of files: embed.py SOURCES BUILD FILE... > embedded.cpp

A file is named relative to the folder of the two that holds it.
"""

import pathlib
import sys


def literal(text):
    """The text as adjacent string literals, one for each line."""
    lines = text.encode().splitlines(keepends=True) or [b""]
    return "\n".join('"' + "".join(escaped(byte) for byte in line) + '"' for line in lines)


def escaped(byte):
    plain = 32 <= byte < 127 and byte not in b'"\\?'
    return chr(byte) if plain else "\\%03o" % byte


def name_of(path, roots):
    path = pathlib.Path(path).resolve()
    return next(str(path.relative_to(root)) for root in roots if path.is_relative_to(root))


def main(roots, paths):
    files = {name_of(path, roots): pathlib.Path(path) for path in paths}
    print('#include "shell/embedded.hpp"')
    print('#pragma GCC diagnostic ignored "-Woverlength-strings"')
    print("namespace aib::shell {")
    print("const std::vector<embedded_file>& embedded_files() {")
    print("  static const std::vector<embedded_file> files = {")
    for name, path in sorted(files.items()):
        print('{"%s",\n%s},' % (name, literal(path.read_text(encoding="utf-8"))))
    print("  };\n  return files;\n}\n}  // namespace aib::shell")


main([pathlib.Path(root).resolve() for root in sys.argv[1:3]], sys.argv[3:])
