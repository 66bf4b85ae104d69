# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Builds somebody else's program upon aib, one way or another, and compares what it prints.

usage: build_theirs.py WAY SOURCE_ROOT BUILD_FOLDER     WAY: meson, pkg-config, cmake or single
"""

import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

EXPECTED = "chamfer 1, abs_rel 0.25\n"
COMPILER = shlex.split(os.environ.get("CXX", "c++"))


def run(*command, **options):
    result = subprocess.run([*map(str, command)], capture_output=True, text=True, **options)
    if result.returncode != 0:
        sys.exit(f"{shlex.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def pkg_config(*arguments, **options):
    return shlex.split(run("pkg-config", *arguments, **options))


def install(build, prefix):
    """Below `prefix` as `meson install` would below /usr/local, headers alone."""
    run("meson", "install", "-C", build, "--no-rebuild", "--tags", "devel", "--destdir", prefix)
    return next(prefix.rglob("aib.pc")).parent.parent.parent


def build_meson(source, build, work):
    shutil.copy(source / "tests/downstream/theirs.meson.build", work / "meson.build")
    shutil.copy(source / "tests/downstream/main.cpp", work)
    (work / "subprojects").mkdir()
    (work / "subprojects/aib").symlink_to(source)
    run("meson", "setup", work / "b", work)
    run("ninja", "-C", work / "b")
    return work / "b/theirs"


def build_pkg_config(source, build, work):
    installed = install(build, work)
    environment = {**os.environ, "PKG_CONFIG_PATH": str(installed / "share/pkgconfig")}
    flags = pkg_config("--cflags", "--libs", "aib", env=environment)
    run(*COMPILER, "-std=c++20", source / "tests/downstream/main.cpp", "-o", work / "theirs", *flags)
    return work / "theirs"


def build_cmake(source, build, work):
    if not shutil.which("cmake"):
        print("SKIPPED: downstream: cmake is not here")
        sys.exit(77)
    prefix = install(build, work)
    run("cmake", "-S", source / "tests/downstream", "-B", work / "b", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", work / "b")
    return work / "b/theirs"


def build_single(source, build, work):
    shutil.copy(source / "single_include/aib/aib.hpp", work)
    include = [f"-I{work}", *pkg_config("--cflags", "eigen3")]
    (work / "aib").mkdir()
    (work / "aib.hpp").rename(work / "aib/aib.hpp")
    flags = ["-std=c++20", "-ffp-contract=off", "-pthread", *include]
    run(*COMPILER, *flags, source / "tests/downstream/main.cpp", "-o", work / "theirs")
    return work / "theirs"


WAYS = {
    "meson": build_meson,
    "pkg-config": build_pkg_config,
    "cmake": build_cmake,
    "single": build_single,
}


def main(way, source, build):
    with tempfile.TemporaryDirectory() as work:
        program = WAYS[way](pathlib.Path(source), pathlib.Path(build), pathlib.Path(work))
        printed = run(program)
    print(f"expected: {EXPECTED}printed:  {printed}", end="")
    return 0 if printed == EXPECTED else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
