# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Damages files of whole folders (a benchmark, results, outputs of methods) and runs what reads them.

usage: folders.py SOURCE_ROOT AIB_LUA [--rounds N] [--sanitized]

Each run ends with its result, of finite numbers, or with one sentence that names what is wrong, no
result, and exit code 3 (1 where an output cannot be written). A round damages a copy of each folder
once, by a random number of its own.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

from zoo import SANITIZER

SECONDS = 60  # a run that takes longer hangs; nothing is measured
ADDRESSES = 4 << 30
BENCHMARK, METHODS, RESULTS = "examples/data", "tests/lua/methods", "results"
QUICK = "--samples 500 --stride 8 --quiet"
# Results that are made first.
MADE = {
    "plain.json": "--per-frame",
    "other.json": "--per-frame --alignment umeyama",
    "first.json": "--shard 1/2",
    "second.json": "--shard 2/2",
    "again.json": "--results {}/kept",
}
# What is damaged, and what then reads it.
JOBS = [
    (BENCHMARK, f"asset_inspection {{}} {QUICK}"),
    (BENCHMARK, "depth {}/methods/sgbm_gtposes/crane/depth {}/gt/crane/depth"),
    (BENCHMARK, "video_depth {}/methods/sgbm_gtposes/crane/depth {}/gt/crane/depth"),
    (BENCHMARK, "depth_surface {}/methods/sgbm_gtposes/crane/depth {}/gt/crane/depth --cameras {}/gt/crane/poses"),
    (BENCHMARK, "trajectory {}/methods/colmap/crane/sparse {}/gt/crane/poses"),
    (BENCHMARK, "pose_auc {}/methods/glomap/crane/sparse {}/gt/crane/poses"),
    (BENCHMARK, "reconstruction {}/methods/sgbm_colmap/crane/fused.ply {}/gt/crane/mesh.ply --samples 500"),
    (BENCHMARK, "telemetry {}/gt/crane/poses --estimate {}/methods/colmap/crane/sparse"),
    (RESULTS, "compare {}/plain.json {}/other.json"),
    (RESULTS, "merge {}/first.json {}/second.json"),
    (RESULTS, f"asset_inspection {BENCHMARK} {QUICK} --results {{}}/kept"),
    *((f"{METHODS}/{name}", "tests/hostile/open_method.lua {}")
      for name in ("cut3r", "da3", "da3_streaming", "monst3r", "pi3", "vggt")),
]
NUMBERS = [b"nan", b"inf", b"-1", b"0", b"1e400", b"99999999999999999999", b"1e-320", b"", b"4294967296", b"0x10"]


def some_bytes(rng, n):
    return bytes(rng.randrange(256) for _ in range(n))


def cut(rng, content):
    return content[: rng.randrange(len(content))]


def turn_a_bit(rng, content):
    at = rng.randrange(len(content))
    return content[:at] + bytes([content[at] ^ 1 << rng.randrange(8)]) + content[at + 1:]


def overwrite(rng, content):
    at, n = rng.randrange(len(content)), rng.choice([1, 4, 8, 64])
    return content[:at] + rng.choice([bytes(n), some_bytes(rng, n)]) + content[at + n:]


def repeat(rng, content):
    at, n = rng.randrange(len(content)), rng.choice([1, 16, 256, 4096])
    return content[: at + n] + content[at:]


def insert(rng, content):
    at = rng.randrange(len(content))
    return content[:at] + some_bytes(rng, rng.choice([1, 2, 9])) + content[at:]


def change_a_number(rng, content):
    found = list(re.finditer(rb"-?\d+\.?\d*(e[-+]?\d+)?", content[:200000]))
    if not found:
        return b""
    number = rng.choice(found)
    return content[: number.start()] + rng.choice(NUMBERS) + content[number.end():]


def exchange_lines(rng, content):
    lines = content.split(b"\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def change_a_value(rng, content):
    """Something of a JSON text is something else, or away."""
    try:
        root = json.loads(content)
    except ValueError:
        return content
    node = [root]
    key = 0
    while isinstance(node[key], (list, dict)) and node[key] and rng.random() < 0.9:
        node = node[key]
        key = rng.choice(list(node)) if isinstance(node, dict) else rng.randrange(len(node))
    node[key] = rng.choice([None, True, "x", "", -1, 0.5, 1e308, 2**60, [], {}, [[]], {"x": 1}, node[key]])
    if rng.random() < 0.3:
        del node[key]
    return json.dumps(root).encode()


CHANGES = [cut, turn_a_bit, overwrite, repeat, insert, change_a_number, exchange_lines]


def damage(rng, path):
    """Spoils a file, and says how."""
    of_json = [change_a_value] * 10 if path.suffix == ".json" else []
    how = rng.choice([*CHANGES, *of_json, "none", "a folder", "empty", "a neighbour"])
    content = path.read_bytes()
    path.unlink()
    if how == "a folder":
        path.mkdir()
    elif how == "empty":
        path.touch()
    elif how == "a neighbour":
        others = sorted(p for p in path.parent.iterdir() if p.is_file())
        path.write_bytes(rng.choice(others).read_bytes() if others else b"")
    elif how != "none":
        path.write_bytes(how(rng, content) if content else b"0")
    return how if isinstance(how, str) else how.__name__.replace("_", " ")


def damaged_files(rng, root, words):
    """Damages one to three files that a command reads; texts are few and small, so they have more weight."""
    inputs = [root / word.removeprefix("{}/").removeprefix("{}") for word in words if word.startswith("{}")]
    below = {p for path in inputs for p in ([path] if path.is_file() else path.rglob("*"))}
    files = sorted(p for p in below if p.is_file() and p.suffix not in (".md", ".py"))
    weights = [5 if p.suffix in (".txt", ".lua", ".ply", ".json") else 1 for p in files]
    chosen = dict.fromkeys(rng.choices(files, weights, k=rng.choice([1, 1, 1, 2, 3])))
    return [f"{path.relative_to(root)}: {damage(rng, path)}" for path in chosen]


def faults_of(run, root, result):
    """What is wrong with how a run ended."""
    said = run.stderr.decode(errors="replace")
    if "traceback" in said or "Sanitizer" in said or run.returncode not in (0, 1, 3):
        yield f"exit code {run.returncode}"
    elif run.returncode != 0:
        if said.count("\n") != 1 or str(root) not in said:
            yield "one line with a path expected"
        if result.exists():
            yield "a result was left"
    elif result.exists():
        numbers = []
        try:
            json.loads(result.read_bytes(), parse_constant=numbers.append)
        except ValueError as problem:
            yield f"the result is no JSON: {problem}"
        yield from (f"the result holds {number}" for number in numbers)


def limit_addresses():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


def make_results(root, aib_lua, folder):
    folder.mkdir()
    for name, flags in MADE.items():
        words = f"asset_inspection {BENCHMARK} {QUICK} {flags.format(folder)} --json {folder / name}"
        subprocess.run([aib_lua, *words.split()], cwd=root, check=True)


def attempt(root, made, aib_lua, is_sanitized, job, seed):
    """(exit code, faults with what explains them)"""
    folder, words = JOBS[job][0], JOBS[job][1].split()
    with tempfile.TemporaryDirectory() as away:
        copy, result = pathlib.Path(away, "folder"), pathlib.Path(away, "result.json")
        shutil.copytree(made if folder == RESULTS else root / folder, copy)
        done = damaged_files(random.Random(f"{job} {seed}"), copy, words)
        command = [aib_lua, *(word.format(copy) for word in words)]
        if not words[0].endswith(".lua"):
            command += ["--quiet", "--json", str(result)]
        try:
            run = subprocess.run(
                command,
                cwd=root,
                capture_output=True,
                timeout=SECONDS * (10 if is_sanitized else 1),
                env={**os.environ, "MALLOC_ARENA_MAX": "1", **(SANITIZER if is_sanitized else {})},
                preexec_fn=None if is_sanitized else limit_addresses,
            )
        except subprocess.TimeoutExpired:
            return "hung", [f"{words[0]}, round {seed}: hung; {done}"]
        said = run.stderr.decode(errors="replace").strip()[-2000:]
        faults = faults_of(run, copy, result)
        return run.returncode, [f"{words[0]}, round {seed}: {fault}; {done}\n  {said}" for fault in faults]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("aib_lua", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--sanitized", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as away, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        made = pathlib.Path(away, RESULTS)
        make_results(options.root, options.aib_lua, made)
        results = list(pool.map(
            lambda at: attempt(options.root, made, options.aib_lua, options.sanitized, *at),
            [(job, seed) for seed in range(options.rounds) for job in range(len(JOBS))],
        ))
    codes = collections.Counter(code for code, _ in results)
    for fault in (fault for _, faults in results for fault in faults):
        print(fault)
    n_failed = sum(bool(faults) for _, faults in results)
    print(f"{len(results)} damaged folders, {len(JOBS)} commands: {codes[0]} gave results, "
          f"{codes[1] + codes[3]} were refused")
    print(f"{len(results) - n_failed} passed, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main())
