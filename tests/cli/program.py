"""The program for tests: its path, small inputs, expected messages and files."""

import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
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
