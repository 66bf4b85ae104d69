#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""What `meson install` lays down works where it lies: test_installed.py BUILD_FOLDER"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1))


def output_of(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True).stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.away = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.away.cleanup)
        output_of("meson", "install", "-C", BUILD, "--no-rebuild", "--destdir", cls.away.name)
        (cls.program,) = pathlib.Path(cls.away.name).rglob("bin/aib-lua")
        cls.share = cls.program.parent.parent / "share"

    def complete(self, *words):
        script = f"""
            source {self.share}/bash-completion/completions/aib-lua
            COMP_WORDS=({self.program} {' '.join(words)} '') COMP_CWORD={len(words)}
            COMP_WORDS[COMP_CWORD]='{words[-1] if words else ''}'
            _aib_lua
            printf '%s\\n' "${{COMPREPLY[@]}}"
        """
        return output_of("bash", "-c", script).split()

    def test_protocols_are_those_that_were_installed(self):
        listed = [line.split()[0] for line in output_of(self.program, "--list").splitlines()]
        installed = sorted(p.stem for p in (self.share / "aib" / "protocols").glob("*.lua"))
        self.assertIn("asset_inspection", installed)
        self.assertEqual(listed, installed)

    def test_the_manual_has_every_option(self):
        (page,) = self.share.rglob("aib-lua.1*")
        manual = page.read_text().replace("\\-", "-")
        for option in re.findall(r"(?<=[ ,])--?[a-zA-Z]+", output_of(self.program, "--help")):
            self.assertRegex(manual, rf"(?m){option}\b", option)

    def test_the_bill_of_materials_has_what_was_linked(self):
        document = json.loads((self.share / "aib" / "aib-lua.spdx.json").read_text())
        names = {package["name"] for package in document["packages"]}
        self.assertLessEqual({"aib-lua", "eigen3", "lua", "nanoflann", "sol2"}, names)
        for package in document["packages"]:
            self.assertRegex(package["versionInfo"], r"^\d", package["name"])

    def test_protocols_are_completed(self):
        self.assertIn("asset_inspection", self.complete("asset_"))
        self.assertEqual(self.complete("kitti_od"), ["kitti_odometry"])

    def test_the_archive_runs_anywhere_from_its_own_libraries_alone(self):
        archive = pathlib.Path(__file__).parents[2] / "lua" / "archive.sh"
        with tempfile.TemporaryDirectory() as away:
            packed = [pathlib.Path(away, name) for name in ("a.tar.gz", "b.tar.gz")]
            for file in packed:
                output_of(archive, file, BUILD)
            self.assertEqual(packed[0].read_bytes(), packed[1].read_bytes())
            output_of("tar", "-C", away, "-xf", packed[0])
            (program,) = pathlib.Path(away).glob("aib-*/bin/aib-lua")
            link = pathlib.Path(away, "a link")
            link.symlink_to(program)
            script = "for line in io.lines '/proc/self/maps' do print((line:match '%s(/.*)$')) end"
            mapped = set(output_of("env", "-i", "/bin/sh", "-c", f"'{link}' -e \"{script}\"").split("\n"))
            libraries = {path for path in mapped if ".so" in path}
            self.assertGreater(len(libraries), 5)
            self.assertEqual({path for path in libraries if not path.startswith(away)}, set())
            self.assertIn("asset_inspection", output_of(link, "--list"))

    def test_options_are_completed(self):
        self.assertEqual(self.complete("--thr"), ["--threads"])
        self.assertEqual(self.complete("trajectory", "--rel"), ["--relation"])


unittest.main()
