# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Compiles the headers on a machine without one of the optional libraries, and without all of them;
poses and depth with Eigen alone.

usage: guards.py SOURCE_ROOT

A library is taken away by a header of its name that is an error.
"""

import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

# The header of each library, and the macros that say that it is here.
LIBRARIES = {
    "zlib.h": ["AIB_WITH_EXR", "AIB_WITH_NPZ"],
    "libdeflate.h": ["AIB_WITH_LIBDEFLATE"],
    "spng.h": ["AIB_WITH_PNG"],
    "jpeglib.h": ["AIB_WITH_JPEG"],
    "nlohmann/json.hpp": ["AIB_WITH_JSON"],
    "pugixml.hpp": ["AIB_WITH_XML"],
}
COMPILER = shlex.split(os.environ.get("CXX", "c++"))


def compiles(root, header, absent):
    with tempfile.TemporaryDirectory() as poison:
        for library in absent:
            path = pathlib.Path(poison, library)
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"#error {library} was to be absent\n")
        here = [macros for library, macros in LIBRARIES.items() if library not in absent]
        macros = [f"-D{macro}" for macro in sum(here, [])]
        eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True).stdout
        command = [*COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", *macros]
        command += [f"-I{poison}", f"-I{root}/include", *eigen.replace("-I", "-isystem").split()]
        command += ["-x", "c++", "-include", header, "/dev/null"]
        run = subprocess.run(command, capture_output=True, text=True)
    print(run.stderr, end="")
    return run.returncode == 0


def main(root):
    tries = [("aib/io.hpp", [library]) for library in LIBRARIES]
    tries += [("aib/aib.hpp", list(LIBRARIES))]
    tries += [(header, [*LIBRARIES, "nanoflann.hpp"]) for header in ("aib/pose.hpp", "aib/depth.hpp")]
    n_failed = 0
    for header, absent in tries:
        is_right = compiles(root, header, absent)
        n_failed += not is_right
        print(f"{'ok' if is_right else 'FAILED'}  {header} without {' '.join(absent)}")
    print(f"{len(tries) - n_failed} passed, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
