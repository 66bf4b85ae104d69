# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Injects faults: full disks, kills, lack of memory, files that are none or vanish, interrupts.

usage: faults.py SOURCE_ROOT AIB_LUA [TEST ...]

After each the exit code holds, one sentence says what happened, and the output is the old file or
the whole new one.
"""

import collections
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT, AIB_LUA = pathlib.Path(sys.argv.pop(1)).resolve(), str(pathlib.Path(sys.argv.pop(1)).resolve())
PATIENCE_S = 60  # a test that waits longer has failed; nothing is measured
NOBODY = 65534
injected = collections.Counter()

# One writer a format; each gives a few kilobytes to `path`.
WRITERS = {
    "a.ply": "aib.io.write_cloud(path, cloud)",
    "m.ply": "aib.io.write_mesh(path, mesh)",
    "a.exr": "aib.io.write_depth(path, depth)",
    "a.pfm": "aib.io.write_depth(path, depth)",
    "a.png": "aib.io.write_depth(path, depth)",
    "a.npy": "aib.io.write_array(path, cloud)",
    "a.txt": "aib.io.write_trajectory(path, poses)",
    "a.kitti": "aib.io.write_trajectory(path, poses)",
    "transforms.json": "aib.io.write_trajectory(path, poses, { cameras = cameras })",
    "poses.npy": "aib.io.write_trajectory(path, poses)",
    "a.csv": "aib.io.write_waypoints(path, poses, { origin = { 48, 11, 520 } })",
    "a.kml": "aib.io.write_waypoints(path, poses, { origin = { 48, 11, 520 } })",
    "a.plan": "aib.io.write_waypoints(path, poses, { origin = { 48, 11, 520 } })",
    "picture.png": "aib.io.write_image(path, aib.depth.error_image(depth, depth))",
    "pieces.ply": "aib.io.cloud_writer(path):add(cloud):add(cloud):commit()",
    "a.svg": "aib.report.plot.write(path, aib.report.plot.ape(poses, poses))",
    "a.json": "aib.system.write_text(path, ('x'):rep(20000))",
    "model": "aib.io.write_trajectory(path, poses, { cameras = cameras })",
}
THINGS = """
local points, rows, list, names, cameras = {}, {}, {}, {}, {}
local camera = aib.math.camera { model = 'PINHOLE', width = 64, height = 48, parameters = { 50, 50, 32, 24 } }
for i = 1, 2000 do points[i] = { math.random(), math.random(), math.random() } end
for y = 1, 64 do
  rows[y] = {}
  for x = 1, 64 do rows[y][x] = 1 + math.random() end
end
for i = 1, 200 do
  list[i], names[i] = aib.math.pose { centre = { math.random(), i, math.random() } }, ('image%04d.png'):format(i)
  cameras[names[i]] = camera
end
local cloud, depth = aib.cloud.from_points(points), aib.depth.map(rows)
local poses = aib.pose.trajectory(list, { names = names })
local path = arg[1]
"""
MESH = "local mesh = aib.io.read_mesh('%s')\n" % (ROOT / "examples/data/gt/crane/mesh.ply")

# One reader a format.
READERS = {
    "a.ply": "aib.io.read_cloud", "a.pcd": "aib.io.read_cloud", "a.las": "aib.io.read_cloud",
    "a.xyz": "aib.io.read_cloud", "a.glb": "aib.io.read_mesh", "a.obj": "aib.io.read_mesh",
    "a.stl": "aib.io.read_mesh", "a.exr": "aib.io.read_depth", "a.pfm": "aib.io.read_depth",
    "a.npz": "aib.io.read_array", "a.npy": "aib.io.read_array", "a.png": "aib.io.read_image",
    "a.jpg": "aib.io.read_image", "a.txt": "aib.io.read_trajectory", "a.json": "aib.system.read_text",
}


def shell(code, *arguments, limits=None, **options):
    """Runs Lua code. limits: called in the child before it begins."""
    with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
        script.write("local aib = require 'aib'\n" + code)
        script.flush()
        return run(script.name, *arguments, limits=limits, **options)


def run(*words, limits=None, **options):
    return subprocess.run([AIB_LUA, *map(str, words)], capture_output=True, text=True, preexec_fn=limits,
                          stdin=subprocess.DEVNULL, timeout=PATIENCE_S, check=False,
                          env={**os.environ, "MALLOC_ARENA_MAX": "1"}, **options)


def limit(what, amount):
    return lambda: resource.setrlimit(what, (amount, amount))


class Faults(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aib faults ü "))  # a blank, and UTF-8
        self.addCleanup(subprocess.run, ["rm", "-rf", self.folder], check=False)

    def names(self):
        return sorted(p.name for p in self.folder.iterdir())

    def refused(self, done, code, *parts):
        """One fault was told in a sentence."""
        injected[self._testMethodName] += 1
        self.assertEqual(done.returncode, code, done.stderr)
        for part in parts:
            self.assertIn(str(part), done.stderr)
        self.assertNotIn("stack traceback", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def said(self, done, part):
        """The script caught the error."""
        injected[self._testMethodName] += 1
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(part, done.stdout)

    # Outputs ---------------------------------------------------------------------------------------

    def write(self, name, writer, limits=None):
        path = self.folder / name
        return path, shell(THINGS + MESH + writer, path, limits=limits)

    def test_a_file_that_grows_too_large_leaves_the_old_one(self):
        for name, writer in WRITERS.items():
            with self.subTest(name):
                path, done = self.write(name, writer)
                self.assertEqual(done.returncode, 0, done.stderr)
                before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
                path, done = self.write(name, writer, limit(resource.RLIMIT_FSIZE, 2000))
                self.refused(done, 1, "cannot write: File too large")
                after = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
                self.assertEqual(after.keys(), before.keys())
                self.assertEqual(after, before)

    def test_a_full_disk_is_told(self):
        for name, writer in WRITERS.items():
            if name == "model":  # a folder
                continue
            with self.subTest(name):
                (self.folder / name).symlink_to("/dev/full")
                _, done = self.write(name, writer)
                self.refused(done, 1, name, "cannot write: No space left on device")
        self.assertEqual(self.names(), sorted(set(WRITERS) - {"model"}))
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([AIB_LUA, "-e", "print(1)"], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.refused(done, 1, "standard output: cannot write: No space left on device")

    def test_a_protocol_whose_result_cannot_be_written(self):
        protocol = self.folder / "p.lua"
        protocol.write_text("return require('aib').protocol { name = 'p', inputs = {}, "
                            "run = function(_, report) report:add('x', 1) end }")
        self.refused(run(protocol, "--quiet", "--json", "/dev/full"), 1, "p: /dev/full: cannot write: No space left")
        self.refused(run(protocol, "--quiet", "--json", self.folder), 2, "a file expected, found a folder")
        self.refused(run(protocol, "--quiet", "--json", self.folder / "no/x.json"), 2, "no such folder")
        done = run(protocol, "--quiet", "--json", "/dev/stdout")
        self.assertIn('"value": 1', done.stdout)

    def test_what_may_not_be_written_stays(self):
        path = self.folder / "a.txt"
        path.write_text("old")
        os.chmod(path, 0o444)
        os.chmod(self.folder, 0o777)
        done = shell_as_nobody("aib.system.write_text(arg[1], 'new')", path)
        self.refused(done, 1, "a.txt: cannot write: Permission denied")
        os.chmod(self.folder, 0o755 if os.geteuid() == 0 else 0o555)
        done = shell_as_nobody("aib.system.write_text(arg[1], 'new')", self.folder / "b.txt")
        self.refused(done, 1, "b.txt: cannot create: Permission denied")
        self.assertEqual((path.read_text(), self.names()), ("old", ["a.txt"]))

    def test_behind_a_link_the_target_is_replaced(self):
        (self.folder / "real.txt").write_text("old")
        (self.folder / "link.txt").symlink_to("real.txt")
        self.assertEqual(shell("aib.system.write_text(arg[1], 'new')", self.folder / "link.txt").returncode, 0)
        self.assertTrue((self.folder / "link.txt").is_symlink())
        self.assertEqual((self.folder / "real.txt").read_text(), "new")
        self.assertEqual(self.names(), ["link.txt", "real.txt"])

    def test_a_kill_leaves_the_old_file_or_the_whole_new_one(self):
        path = self.folder / "out.txt"
        code = """
            for i = 0, math.huge do
              aib.system.write_text(arg[1], string.char(97 + i % 26):rep(3000000))
              if i == 1 then print('going') io.stdout:flush() end
            end"""
        random.seed(1)
        for _ in range(10):
            with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
                script.write("local aib = require 'aib'\n" + code)
                script.flush()
                with subprocess.Popen([AIB_LUA, script.name, path], stdout=subprocess.PIPE) as process:
                    process.stdout.readline()
                    time.sleep(random.uniform(0, 0.03))
                    process.kill()
            content = path.read_bytes()
            injected[self._testMethodName] += 1
            self.assertEqual((len(content), len(set(content))), (3000000, 1))

    def test_a_kill_leaves_one_of_two_files_whatever_the_format(self):
        random.seed(3)
        for name, writer in WRITERS.items():
            with self.subTest(name), tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
                script.write("local aib = require 'aib'\nmath.randomseed(1)\n" + THINGS + MESH + writer
                             + "\nprint('going') io.stdout:flush() while true do " + writer + " end")
                script.flush()
                with subprocess.Popen([AIB_LUA, script.name, self.folder / name], stdout=subprocess.PIPE) as process:
                    process.stdout.readline()
                    whole = self.contents(name)
                    time.sleep(random.uniform(0, 0.03))
                    process.kill()
                injected[self._testMethodName] += 1
                self.assertEqual(self.contents(name), whole)

    def contents(self, name):
        """The bytes of a file, or of the files of a folder without those that a killed writer left beside them."""
        path = self.folder / name
        files = [path] if path.is_file() else sorted(p for p in path.iterdir() if p.suffix in (".bin", ".txt"))
        return {file.name: file.read_bytes() for file in files}

    # Memory ----------------------------------------------------------------------------------------

    def big_ply(self):
        """A good file of 40 million points, almost all of it a hole."""
        path = self.folder / "big.ply"
        header = ("ply\nformat binary_little_endian 1.0\nelement vertex 40000000\nproperty float x\n"
                  "property float y\nproperty float z\nend_header\n").encode()
        with open(path, "wb") as file:
            file.write(header)
            file.truncate(len(header) + 12 * 40000000)
        return path

    def test_no_memory_for_a_file_is_a_sentence(self):
        done = shell("print(aib.io.read_cloud(arg[1]))", self.big_ply(), limits=limit(resource.RLIMIT_AS, 400 << 20))
        self.refused(done, 1, "not enough memory")
        protocol = self.folder / "p.lua"
        protocol.write_text("local aib = require 'aib' return aib.protocol { name = 'p', inputs = { est = { kind = 'file' } }, "
                            "run = function(input, report) report:add('n', #aib.io.read_cloud(input.est)) end }")
        out = self.folder / "out.json"
        done = run(protocol, self.folder / "big.ply", "--json", out, limits=limit(resource.RLIMIT_AS, 400 << 20))
        self.refused(done, 1, "p: not enough memory")
        self.assertFalse(out.exists())

    def test_no_memory_for_lua_is_a_sentence(self):
        eat = "local t = {} for i = 1, math.huge do t[i] = ('x'):rep(1000) .. i end"
        (self.folder / "s.lua").write_text(eat)
        self.refused(run("--sandbox", "--memory", "50", self.folder / "s.lua"), 1, "not enough memory")
        (self.folder / "p.lua").write_text("return require('aib').protocol { name = 'p', inputs = {}, run = function() "
                                           + eat + " end }")
        self.refused(run("--sandbox", "--memory", "50", self.folder / "p.lua"), 1, "not enough memory")

    def test_where_no_thread_can_be_started_fewer_do_the_work(self):
        code = ("local p = {} for i = 1, 60000 do p[i] = { i % 97, i % 89, i % 83 } end\n"
                "local c = aib.cloud.from_points(p) print(('%a'):format(aib.cloud.compare(c, c).f1_distance), #p)")
        alone = shell(code).stdout
        with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
            script.write("local aib = require 'aib'\n" + code)
            script.flush()
            done = run("--threads", 64, script.name, limits=limit(resource.RLIMIT_AS, 250 << 20))
        injected[self._testMethodName] += 1
        self.assertEqual((done.returncode, done.stdout), (0, alone), done.stderr)

    # Inputs ----------------------------------------------------------------------------------------

    def test_inputs_that_are_no_files(self):
        for name, reader in READERS.items():
            path = self.folder / name
            makers = {"folder": path.mkdir, "pipe": lambda: os.mkfifo(path), "link to nothing": lambda: path.symlink_to("x"),
                      "device": lambda: path.symlink_to("/dev/zero"), "nothing": lambda: None}
            for kind, make in makers.items():
                with self.subTest(name, kind=kind):
                    make()
                    done = shell(f"print({reader}(arg[1]))", path)
                    self.refused(done, 3, self.folder)
                    subprocess.run(["rm", "-rf", path], check=True)

    def test_names_that_no_file_can_have(self):
        for name in ("x" * 300, "/".join(["loop"] * 3)):
            (self.folder / "loop").unlink(missing_ok=True)
            (self.folder / "loop").symlink_to("loop")
            for reader in ("read_trajectory", "read_cameras", "read_colmap", "read_cloud", "read_opensfm_components"):
                with self.subTest(reader, name=name[:9]):
                    self.refused(shell(f"aib.io.{reader}(arg[1])", self.folder / name), 3, self.folder)

    def test_an_input_that_may_not_be_read(self):
        path = self.folder / "a.ply"
        path.write_text("ply\n")
        os.chmod(path, 0)
        os.chmod(self.folder, 0o755)
        self.refused(shell_as_nobody("aib.io.read_cloud(arg[1])", path), 3, "cannot open: Permission denied")

    def test_names_with_a_zero_byte_are_refused(self):
        for call in ("aib.io.read_cloud('a\\0b.ply')", "aib.system.write_text('a\\0b.txt', 'x')"):
            done = shell(f"print(select(2, pcall(function() {call} end)))", cwd=self.folder)
            self.said(done, "path (string) expected, found string 'a\\0b.")
            self.assertEqual(self.names(), [])

    def test_files_that_vanish_or_shrink_while_being_read(self):
        stack = ("local rows = {} for i = 1, 100000 do rows[i] = { { 1, 2 }, { 3, 4 } } end\n"
                 "aib.io.write_array(arg[1], rows)\nlocal s = aib.io.open_stack(arg[1])\n")
        path = self.folder / "a.npy"
        done = shell(stack + "assert(io.open(arg[1], 'w')):close() print(s[90000])", path)
        self.refused(done, 3, "a.npy: byte", "the file ends")
        done = shell(stack + "os.remove(arg[1]) print(s[90000])", path)
        self.assertEqual(done.returncode, 0, done.stderr)  # what is open stays there
        frames = "aib.depth.evaluate({{ name = 'a', estimate = arg[1], reference = arg[1] }})"
        done = shell(THINGS + "aib.io.write_depth(path, depth) os.remove(path)\n" + frames, self.folder / "b.pfm")
        self.refused(done, 3, "b.pfm: cannot open")

    # Interrupts ------------------------------------------------------------------------------------

    # What calls work on, as globals.
    LARGE = """
        local function random_points(n)
          local points = {}
          for i = 1, n do points[i] = { math.random(), math.random(), math.random() } end
          return points
        end
        local function poses(n)
          local list = {}
          for i, p in ipairs(random_points(n)) do list[i] = aib.math.pose { centre = p } end
          return aib.pose.trajectory(list)
        end
        local rows, numbers, frames = {}, {}, {}
        for y = 1, 300 do rows[y] = {} for x = 1, 400 do rows[y][x] = 1 + math.random() end end
        for i = 1, 20000 do numbers[i] = math.random() end
        local map = aib.depth.map(rows)
        aib.io.write_depth(arg[1] .. '/d.exr', map)
        for i, _ in ipairs(numbers) do
          frames[i] = { name = '' .. i, estimate = arg[1] .. '/d.exr', reference = arg[1] .. '/d.exr' }
        end
        local mesh, middle_map = aib.io.read_mesh(arg[2]), aib.depth.downsample(map, 2000, 1500)
        for name, value in pairs {
          poses = poses(30000), numbers = numbers, map = map, frames = frames, mesh = mesh,
          small = aib.cloud.from_points(random_points(20000)),
          large = aib.sample.mesh(mesh, { n = 1000000 }), other = aib.sample.mesh(mesh, { n = 1000000, seed = 2 }),
          large_map = aib.depth.downsample(map, 4000, 3000), picture = aib.depth.error_image(middle_map, middle_map),
          camera = aib.math.camera { model = 'OPENCV', width = 400, height = 300,
            parameters = { 400, 400, 200, 150, 0.1, 0.01, 0.001, 0.001 } },
        } do rawset(_G, name, value) end
    """

    # Calls of the library that take seconds on one thread.
    LONG = {
        "auc": "aib.pose.auc(poses, poses)",
        "bootstrap": "aib.stats.bootstrap(numbers, { resamples = 1000000 })",
        "compare": "aib.cloud.compare(large, other)",
        "frames": "aib.depth.evaluate(frames)",
        "icp": "aib.align.icp(large, other, { max_distance = 1, relative_change = 0 })",
        "noise": "aib.survey.sensor_noise(picture)",
        "normal consistency": "aib.cloud.normal_consistency(large, other)",
        "normals": "aib.cloud.with_normals(large, { neighbours = 200 })",
        "offsets": "aib.cloud.offsets(large, other)",
        "poisson": "aib.sample.mesh(mesh, { n = 1000000, method = 'poisson' })",
        "radius outliers": "aib.cloud.without_radius_outliers(large, { radius = 1 })",
        "statistical outliers": "aib.cloud.without_statistical_outliers(large, { neighbours = 200 })",
        "thin": "aib.sample.thin(large, { spacing = 1e-6 })",
        "unproject": "aib.sample.unproject(large_map, camera, aib.math.pose {})",
    }

    def test_an_interrupt_ends_a_long_call_and_the_session_goes_on(self):
        with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
            script.write("local aib = require 'aib'\n" + self.LARGE)
            script.flush()
            words = [AIB_LUA, "--threads", "1", "-i", script.name, self.folder, ROOT / "examples/data/gt/crane/mesh.ply"]
            with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as lua:
                for name, call in self.LONG.items():
                    with self.subTest(name):
                        lua.stdin.write(f"print('going') io.stdout:flush() {call} print('it came to its end')\n")
                        lua.stdin.flush()
                        self.assertTrue(lua.stdout.readline().endswith("going\n"), lua.poll())
                        time.sleep(0.1)
                        lua.send_signal(signal.SIGINT)
                        lua.stdin.write("print('here') io.stdout:flush()\n")
                        lua.stdin.flush()
                        self.assertTrue(lua.stdout.readline().endswith("> here\n"), lua.poll())
                        injected[self._testMethodName] += 1
                lua.communicate(timeout=PATIENCE_S)
            self.assertEqual(lua.returncode, 0)

    def test_no_thread_is_left_after_an_interrupt_or_an_error(self):
        calls = {name: self.LONG[name] for name in ("auc", "compare", "frames", "normals", "offsets", "unproject")}
        calls["failing"] = "frames[#frames + 1] = { name = 'x', estimate = 'no', reference = 'no' } aib.depth.evaluate(frames)"
        with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
            script.write("local aib = require 'aib'\n" + self.LARGE)
            script.flush()
            words = [AIB_LUA, "--threads", "3", "-i", script.name, self.folder, ROOT / "examples/data/gt/crane/mesh.ply"]
            with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as lua:
                def threads():
                    return len(os.listdir(f"/proc/{lua.pid}/task"))

                most = 1
                for name, call in calls.items():
                    with self.subTest(name):
                        lua.stdin.write(f"print('going') io.stdout:flush() {call}\n")
                        lua.stdin.flush()
                        self.assertTrue(lua.stdout.readline().endswith("going\n"), lua.poll())
                        time.sleep(0.1)
                        most = max(most, threads())
                        lua.send_signal(signal.SIGINT)
                        lua.stdin.write("print('here') io.stdout:flush()\n")
                        lua.stdin.flush()
                        self.assertTrue(lua.stdout.readline().endswith("> here\n"), lua.poll())
                        self.assertEqual(threads(), 1)
                        injected[self._testMethodName] += 1
                lua.communicate(timeout=PATIENCE_S)
            self.assertEqual((lua.returncode, most), (0, 3))

    # These run until they are interrupted.
    ENDLESS = {
        "voxels": "while true do aib.sample.voxel(small, { size = 0.01 }) end",
        "files": "while true do aib.io.write_depth(arg[1] .. '/a.exr', map) aib.io.read_depth(arg[1] .. '/a.exr') end",
        "protocol": "aib.protocol { name = 'p', inputs = {}, run = function() while true do pcall(error) end end }:main {}",
    }

    def test_an_interrupt_ends_a_script(self):
        for name, code in {**self.ENDLESS, "frames": self.LONG["frames"]}.items():
            with self.subTest(name), tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
                script.write("local aib = require 'aib'\n" + self.LARGE + "print('going') io.stdout:flush()\n" + code
                             + "\nprint('it came to its end')")
                script.flush()
                with subprocess.Popen([AIB_LUA, script.name, self.folder, ROOT / "examples/data/gt/crane/mesh.ply"],
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                    self.assertEqual(process.stdout.readline(), "going\n")
                    time.sleep(0.1)
                    process.send_signal(signal.SIGINT)
                    out, err = process.communicate(timeout=PATIENCE_S)
                injected[self._testMethodName] += 1
                self.assertEqual((process.returncode, out), (130, ""), err)

    def test_killed_runs_with_results_end_as_one_run(self):
        protocol, data, kept = (ROOT / "examples/protocols/asset_inspection.lua", ROOT / "examples/data", self.folder / "kept")

        def words(out):
            return [protocol, data, "--quiet", "--samples", "2000", "--json", self.folder / out]

        self.assertEqual(run(*words("plain.json")).returncode, 0)
        full = run(*words("full.json"), "--results", kept, limits=limit(resource.RLIMIT_FSIZE, 1000))
        self.refused(full, 1, "cannot write: File too large")
        self.assertFalse((self.folder / "full.json").exists())
        random.seed(2)
        for _ in range(4):
            with subprocess.Popen([AIB_LUA, *map(str, words("killed.json")), "--results", kept]) as process:
                time.sleep(random.uniform(0.1, 0.8))
                process.kill()
            injected[self._testMethodName] += 1
        self.assertEqual(run(*words("again.json"), "--results", kept).returncode, 0)
        self.assertEqual((self.folder / "again.json").read_bytes(), (self.folder / "plain.json").read_bytes())


def shell_as_nobody(code, *arguments):
    """The program is copied to where nobody may run it."""
    with tempfile.TemporaryDirectory() as away:
        os.chmod(away, 0o755)
        program = shutil.copy(AIB_LUA, away)
        return subprocess.run([program, "-", *map(str, arguments)], input="local aib = require 'aib'\n" + code, text=True,
                              capture_output=True, timeout=PATIENCE_S, check=False,
                              **({"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}))


if __name__ == "__main__":
    outcome = unittest.main(exit=False).result
    print("faults that were injected and answered:")
    for name, n in sorted(injected.items()):
        print(f"  {n:4}  {name.removeprefix('test_').replace('_', ' ')}")
    print(f"  {injected.total():4}  in all")
    sys.exit(not outcome.wasSuccessful())
