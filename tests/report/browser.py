# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The page of the bundled benchmark in a headless browser: browser.py AIB_LUA

Writes the page, installs the driver that package-lock.json pins into the build folder, and runs
browser.mjs. Skipped (77) where Node.js, a browser or the driver is missing, or the page has no script.
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent.parent
BROWSERS = ["chromium", "chromium-browser", "google-chrome"]


def skip(reason):
    print(f"SKIPPED: report in a browser: {reason}")
    sys.exit(77)


def install(folder):
    """The driver, once for each lock file."""
    folder.mkdir(exist_ok=True)
    stamp, lock = folder / "node_modules" / "installed.json", (HERE / "package-lock.json").read_text()
    for name in ["package.json", "package-lock.json", ".npmrc", "browser.mjs"]:
        shutil.copy(HERE / name, folder)
    if stamp.is_file() and stamp.read_text() == lock:
        return
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline", "--fetch-retries=1"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        skip("npm cannot install playwright-core: " + done.stderr.strip()[:200])
    stamp.write_text(lock)


def worse(result):
    """The result with depth errors a tenth larger, on every third frame twice as large."""
    for record in result["records"]:
        if record["name"] == "depth.srmse" and record["value"] is not None:
            record["value"] *= 1.1
    for frames in result["frames"]:
        frames["values"] = [x * (1.1 if i % 3 else 2) for i, x in enumerate(frames["values"])]
    return result


def write_pages(aib_lua, folder):
    def run(*words):
        subprocess.run([aib_lua, *map(str, words)], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)

    protocols = ROOT / "examples" / "protocols"
    run(protocols / "asset_inspection.lua", "examples/data", "--per-frame", "--html", folder / "benchmark.html",
        "--json", folder / "a.json")
    (folder / "b.json").write_text(json.dumps(worse(json.loads((folder / "a.json").read_text()))))
    run(protocols / "compare.lua", folder / "a.json", folder / "b.json", "--html", folder / "compare.html")
    run(HERE / "labels.lua", "--html", folder / "labels.html")


def main(aib_lua):
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not shutil.which("node") or not shutil.which("npm"):
        skip("node and npm are not here")
    if not browser:
        skip("no Chromium is here")
    place = pathlib.Path(aib_lua).parent.parent / "tests" / "report"
    place.mkdir(parents=True, exist_ok=True)
    install(place / "driver")
    with tempfile.TemporaryDirectory() as folder:
        write_pages(aib_lua, pathlib.Path(folder))
        if "DecompressionStream" not in pathlib.Path(folder, "benchmark.html").read_text():
            skip("this aib-lua was built without the page's script")
        command = ["node", str(place / "driver" / "browser.mjs"), browser, folder, *sys.argv[2:]]
        sys.exit(subprocess.run(command).returncode)


main(str(pathlib.Path(sys.argv[1]).resolve()))
