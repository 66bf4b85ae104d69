# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Writes C++ that holds the text of files: embed.py ROOT FILE... > embedded.cpp"""

import pathlib
import sys


def literal(text):
    """The text as adjacent string literals, one for each line."""
    lines = text.encode().splitlines(keepends=True) or [b""]
    return "\n".join('"' + "".join(escaped(byte) for byte in line) + '"' for line in lines)


def escaped(byte):
    plain = 32 <= byte < 127 and byte not in b'"\\?'
    return chr(byte) if plain else "\\%03o" % byte


def main(root, paths):
    files = {str(pathlib.Path(path).resolve().relative_to(root)): pathlib.Path(path) for path in paths}
    print('#include "shell/embedded.hpp"')
    print('#pragma GCC diagnostic ignored "-Woverlength-strings"')
    print("namespace aib::shell {")
    print("const std::vector<embedded_file>& embedded_files() {")
    print("  static const std::vector<embedded_file> files = {")
    for name, path in sorted(files.items()):
        print('{"%s",\n%s},' % (name, literal(path.read_text(encoding="utf-8"))))
    print("  };\n  return files;\n}\n}  // namespace aib::shell")


main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:])
