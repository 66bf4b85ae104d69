# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Renders frames of a transforms.json, or exports a .blend file. For Blender 3.4 to 4.x, without a display:

  blender -b --factory-startup --python-exit-code 1 -P run.py -- render --mesh mesh.ply --transforms transforms.json
          --out FOLDER [--soiling low] [--frames 0:100:2] [--samples 64] [--maps images,depth]
  blender -b mine.blend --python-exit-code 1 -P run.py -- export --out FOLDER [--cameras all]
  blender -b mine.blend --python-exit-code 1 -P run.py -- render --transforms FOLDER/transforms.json --out FOLDER

Plans nothing: positions come from the file alone.
"""

import argparse
import pathlib
import sys
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import export  # noqa: E402
import materials  # noqa: E402
import render  # noqa: E402


def soiling(text):
    try:
        value = materials.SOILING.get(text)
        value = float(text) if value is None else value
    except ValueError:
        value = -1
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"0 to 1 or one of {', '.join(materials.SOILING)} expected, found {text}")
    return value


def parse(words):
    parser = argparse.ArgumentParser(prog="run.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    drawing = commands.add_parser("render")
    drawing.set_defaults(run=render.run)
    drawing.add_argument("--transforms", required=True)
    drawing.add_argument("--out", required=True)
    drawing.add_argument("--mesh", help="labelled PLY; without it the .blend file that is open")
    drawing.add_argument("--soiling", type=soiling, default=0.05, help="of glass: 0 to 1, or very_low, low, medium, high")
    drawing.add_argument("--frames", default="", help="START:STOP:STEP of the frames, as in Python; or one number")
    drawing.add_argument("--samples", type=int, default=64)
    drawing.add_argument("--seed", type=int, default=0, help="frame k is drawn with seed + k")
    drawing.add_argument("--width", type=int, help="pixels; default: the camera's")
    drawing.add_argument("--maps", default="images", help="images, depth or both with a comma")
    drawing.add_argument("--device", choices=("auto", "cpu", "gpu"), default="auto")
    drawing.add_argument("--denoise", choices=("auto", "on", "off"), default="auto")
    drawing.add_argument("--threads", type=int, default=0, help="0: all")
    exporting = commands.add_parser("export")
    exporting.set_defaults(run=export.run)
    exporting.add_argument("--out", required=True)
    exporting.add_argument("--cameras", choices=("active", "all"), default="active",
                           help="the active one at every frame of the animation, or all at the current frame")
    return parser.parse_args(words)


def main():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    options = parse(words)
    try:
        options.run(options)
    except (ValueError, RuntimeError, OSError, KeyError) as error:
        print(f"run.py: {type(error).__name__}: {error}", file=sys.stderr)
        sys.exit(1)
    except Exception:
        traceback.print_exc()
        sys.exit(1)


main()
