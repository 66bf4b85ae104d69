# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The page's files where there is no Node.js: the style alone: plain.py STYLE OUTPUT"""

import pathlib
import re
import sys


def main(style, output):
    text = pathlib.Path(style).read_text(encoding="utf-8")
    plain = re.sub(r"^@import.*\n", "", text, flags=re.MULTILINE)
    for name, content in {"page.js": "", "page.css": plain, "licences.txt": ""}.items():
        pathlib.Path(output, name).write_text(content, encoding="utf-8")


main(*sys.argv[1:])
