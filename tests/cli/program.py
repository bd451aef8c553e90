"""The program for tests: its path, small inputs, expected messages and files."""

import contextlib
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["COLLARMESH_PROGRAM"]
SOURCES = pathlib.Path(__file__).resolve().parents[2]
MODELS = SOURCES / "resources" / "models"
COORDINATES = re.compile(r"\(?-?\d[\d.e+-]*, ?-?\d[\d.e+-]*, ?-?\d[\d.e+-]*\)?")

BOX_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box_points(low=(0, 0, 0), high=(1, 1, 1)):
    return [(x, y, z) for z in (low[2], high[2])
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]


def off_text(points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(str, p)) for p in points]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines) + "\n"


def wedge_text(degrees):
    """Returns a prism whose cross-section has this angle at the edge from (0, 0, 0) to (0, 0, 1)."""
    t = math.radians(degrees)
    corners = [(0, 0), (1, 0), (math.cos(t), math.sin(t))]
    points = [(x, y, z) for z in (0, 1) for x, y in corners]
    return off_text(points, [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)])


def wait_for(event, what, seconds=60):
    """Waits until `event()` returns something true, and returns that."""
    end = time.monotonic() + seconds
    while not (value := event()):
        if time.monotonic() > end:
            raise AssertionError(f"{what}: it has not come to this")
        time.sleep(0.002)
    return value


def children_of(pid):
    """Returns the numbers of the child processes of all threads of a process."""
    found = []
    for path in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):  # a thread that has ended
            found += map(int, path.read_text().split())
    return found


def has_signal(pid, mask, number):
    """Returns whether a signal is in a mask of the process: SigCgt (it has a handler), ShdPnd (it is still to come)."""
    bits = re.search(rf"^{mask}:\s*(\w+)", pathlib.Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)[1]
    return bool(int(bits, 16) >> (number - 1) & 1)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="collarmesh-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.box = self.write("box.off", off_text(box_points(), BOX_FACES))
        self.out = self.folder / "out.vtu"

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def run_program(self, *arguments, timeout=120):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=timeout,
                              capture_output=True, text=True)

    def expect(self, code, *arguments, says=(), writes=False):
        """Runs the program; checks the exit code, the messages and whether the mesh exists."""
        run = self.run_program(*arguments)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        for text in says:
            self.assertRegex(run.stderr + run.stdout, text)
        self.assertEqual(self.out.exists(), writes)
        self.assert_nothing_left()
        return run

    def assert_nothing_left(self):
        left = [p.name for p in self.folder.iterdir() if p.name.startswith(".") or "tmp" in p.name]
        self.assertEqual(left, [], "temporary files were left")
