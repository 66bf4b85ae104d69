# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""No committed file names a folder of somebody's machine or a package host.

usage: names.py SOURCE_ROOT
"""

import pathlib
import re
import subprocess
import sys

# Written so that they do not match themselves.
FORBIDDEN = re.compile(r"/[w]ork/|/[t]mp/b-|/[h]ome/\w|/[r]oot/|deb\.[d]ebian\.org|\b[p]ypi\.|\b[n]pmjs\.")


def main(root):
    listing = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, text=True)
    if listing.returncode != 0:
        print("SKIPPED: names: not a git checkout")
        return 77
    n_faults = 0
    for name in filter(None, listing.stdout.split("\0")):
        path = pathlib.Path(root, name)
        if not path.is_file() or b"\0" in (content := path.read_bytes()):
            continue
        for number, line in enumerate(content.decode(errors="replace").splitlines(), 1):
            match = FORBIDDEN.search(line)
            if match:
                n_faults += 1
                print(f"{name}:{number}: names {match[0]}")
    return 1 if n_faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
