#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Writes the headers that are made from headers: the umbrellas and the single one.

usage: amalgamate.py [--check]     --check writes nothing and names what is out of date

include/aib/<folder>.hpp   holds every header of its folder
include/aib/aib.hpp        holds every folder
single_include/aib/aib.hpp is all of it in one file

A header that needs an optional library stands behind the macro that says that the library is here
(`AIB_WITH_EXR`, ...). The same headers give the same bytes.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = ROOT / "include"

# Folders in the order of the floors, and what each umbrella says of itself.
FOLDERS = {
    "core": "errors, concepts, threads, randomness",
    "math": "rotations, transforms, cameras",
    "stats": "mergeable moments, quantiles, histograms",
    "raster": "images and views of images",
    "search": "nearest neighbours and ray queries",
    "depth": "depth maps and their errors",
    "pose": "trajectories and their errors; needs Eigen alone",
    "cloud": "point clouds and the distances between them",
    "mesh": "triangle meshes and distances to them",
    "align": "transforms that bring an estimate onto a reference",
    "sample": "clouds from meshes, depth maps and voxels",
    "survey": "flights: planned, measured, and what goes wrong with them",
    "render": "depth, normals and labels of meshes by rays",
    "io": "readers and writers",
    "report": "data as the page of a report carries it",
    "stream": "drivers over files larger than memory",
}

# How the includes of an optional library begin, and when it is here.
OPTIONAL = {
    "zlib.h": "defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)",
    "libdeflate.h": "defined(AIB_WITH_LIBDEFLATE)",
    "spng.h": "defined(AIB_WITH_PNG)",
    "jpeglib.h": "defined(AIB_WITH_JPEG)",
    "nlohmann/": "defined(AIB_WITH_JSON)",
    "pugixml.hpp": "defined(AIB_WITH_XML)",
    "embree": "defined(AIB_WITH_EMBREE)",
}

HEAD = "// SPDX-FileCopyrightText: the aib authors\n// SPDX-License-Identifier: MIT\n"
INCLUDE_LINE = re.compile(r"\s*#\s*include\s*<(.+?)>")


def lines_of(header):
    """(line, what it includes or None, "always", "if" or "else") of each line below the head."""
    branches = []
    text = (INCLUDE / header).read_text().removeprefix(HEAD).lstrip("\n").removeprefix("#pragma once\n")
    for line in text.splitlines():
        directive = re.match(r"\s*#\s*(if|else|endif)", line)
        if directive and directive[1] != "if":
            branches.pop()
        if directive and directive[1] != "endif":
            branches.append(directive[1])
        include = INCLUDE_LINE.match(line)
        yield line, include[1] if include else None, branches[-1] if branches else "always"


def is_own(included):
    return included.startswith("aib/")


def guards_of(header, known):
    """Conditions without which the header cannot be compiled, from what it includes in any case. An
    optional library behind #else is one: the header does not do without it, only otherwise."""
    if header not in known:
        known[header] = set()
        for _, included, branch in lines_of(header):
            if not included or branch == "if":
                continue
            if is_own(included):
                known[header] |= guards_of(included, known)
            known[header] |= {here for start, here in OPTIONAL.items() if included.startswith(start)}
    return known[header]


def guarded(text, guards):
    if not guards:
        return text
    alone = len(guards) == 1
    condition = " && ".join(g if alone or "||" not in g else f"({g})" for g in sorted(guards))
    return f"#if {condition}\n{text}#endif\n"


def umbrella(about, headers, known):
    """Headers that need the same libraries stand together, those that need none first."""
    groups = {}
    for header in headers:
        groups.setdefault(tuple(sorted(guards_of(header, known))), []).append(header)
    blocks = [
        guarded("".join(f"#include <{header}>\n" for header in groups[guards]), guards)
        for guards in sorted(groups)
    ]
    return f"{HEAD}#pragma once\n\n/// @file\n/// {about}\n\n" + "\n".join(blocks)


def umbrellas(known):
    """{path below include/: text}"""
    listed = re.findall(r"^  '(aib/.+\.hpp)',$", (INCLUDE / "meson.build").read_text(), re.MULTILINE)
    made, folders = {}, []
    for folder, about in FOLDERS.items():
        headers = sorted(header for header in listed if header.startswith(f"aib/{folder}/"))
        if headers:
            made[f"aib/{folder}.hpp"] = umbrella(f"{about[0].upper()}{about[1:]}.", headers, known)
            folders.append(f"aib/{folder}.hpp")
    lines = "".join(f"#include <{folder}>\n" for folder in sorted(folders))
    made["aib/aib.hpp"] = f"{HEAD}#pragma once\n\n/// @file\n/// The whole library.\n\n{lines}"
    return made


def in_order(header, done):
    """Every own header below, each after those it includes."""
    for _, included, _ in lines_of(header):
        if included and is_own(included) and included not in done:
            in_order(included, done)
    done.setdefault(header)
    return done


def body_of(header, guards, hoisted):
    """The text without own includes; what every build includes is collected in `hoisted` instead."""
    kept = []
    for line, included, branch in lines_of(header):
        if included and is_own(included):
            continue
        is_optional = included and any(included.startswith(start) for start in OPTIONAL)
        if included and branch == "always" and not is_optional:
            hoisted.add(included)
            continue
        kept.append(line)
    text = re.sub(r"\n{3,}", "\n\n", "\n".join(kept)).strip("\n")
    return f"// {header}\n\n" + guarded(text + "\n", guards) if text else ""


def single_header(known):
    version = re.search(r"version: '([^']+)'", (ROOT / "meson.build").read_text())[1]
    headers = [h for h in in_order("aib/aib.hpp", {}) if not re.fullmatch(r"aib/\w+\.hpp", h)]
    hoisted = set()
    bodies = [body_of(header, guards_of(header, known), hoisted) for header in headers]
    third_party = sorted(h for h in hoisted if "/" in h and not h.startswith("sys/") or h.endswith(".hpp"))
    system = sorted(hoisted.difference(third_party))
    includes = "\n".join("".join(f"#include <{h}>\n" for h in block) for block in (third_party, system))
    return (
        f"{HEAD}//\n// aib {version}, the whole library in one header, made by single_include/amalgamate.py.\n"
        "// Compile with -std=c++20 -ffp-contract=off: results are then the same bits on every machine.\n"
        f"#pragma once\n\n{includes}\n" + "\n".join(filter(None, bodies))
    )


def refresh(path, text, is_check):
    if path.exists() and path.read_text() == text:
        return True
    if is_check:
        print(f"{path.relative_to(ROOT)} is out of date: run `meson compile -C build amalgamate`")
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return True


def main(*flags):
    is_check = "--check" in flags
    known = {}
    is_fresh = [refresh(INCLUDE / path, text, is_check) for path, text in umbrellas(known).items()]
    is_fresh.append(refresh(ROOT / "single_include" / "aib" / "aib.hpp", single_header(known), is_check))
    print(f"{sum(is_fresh)} passed, {is_fresh.count(False)} failed")
    return 0 if all(is_fresh) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
