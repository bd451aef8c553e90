"""Surfaces on their own on the command line: open ones, formats, the certificate of a file, what is wrong.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import unittest

from program import BOX_FACES, ProgramTest, box_points, off_text


class Shells(ProgramTest):
    def setUp(self):
        super().setUp()
        self.open = self.write("open.off", off_text(box_points(), BOX_FACES[:-1]))

    def test_an_open_surface_is_meshed_and_certified(self):
        square = self.write("square.off", off_text(box_points()[:4], [(0, 1, 2, 3)]))
        self.expect(4, square, "-o", self.out, "--size", "0.2", says=["--dimension 2"])
        self.expect(0, square, "-o", "square.vtu", "--size", "0.2", "--dimension", "2")
        self.expect(0, self.open, "-o", self.out, "--size", "0.2", "--dimension", "2", "--report", "r.json",
                    says=["triangles", "every guarantee holds"], writes=True)
        check = json.loads((self.folder / "r.json").read_text())["check"]
        self.assertGreaterEqual(check["triangles"]["min_angle"], 20)
        self.assertLessEqual(check["triangles"]["max_angle"], 120)
        self.assertAlmostEqual(sum(k["mesh"] for k in check["kept"]["patch_areas"]), 5, 9)
        for name in ("out.vtu", "next.msh", "next.mesh"):
            self.run_program(self.open, "-o", name, "--size", "0.2", "--dimension", "2")
            run = self.run_program("check", name, "--against", self.open)
            self.assertEqual(run.returncode, 0, name + run.stdout + run.stderr)
        self.assertNotEqual(self.run_program("check", "out.vtu", "--against", self.box).returncode, 0)

    def test_formats(self):
        for name in ("a.stl", "a.off", "a.obj", "a.vtk", "a.msh", "a.msh2", "a.mesh", "a.inp", "a.unv"):
            run = self.run_program(self.box, "-o", name, "--size", "0.3", "--dimension", "2")
            self.assertEqual(run.returncode, 0, name + run.stderr)
            self.assertGreater((self.folder / name).stat().st_size, 1000)
        text = (self.folder / "a.inp").read_text()
        self.assertIn("TYPE=S3, ELSET=PATCH_1", text)
        self.assertNotIn("C3D4", text)
        self.run_program(self.box, "-o", "b.inp", "--size", "0.3", "--dimension", "2", "--order", "2")
        self.assertIn("TYPE=S6", (self.folder / "b.inp").read_text())

    def test_what_is_wrong_is_told(self):
        self.expect(2, self.box, "-o", "a.su2", "--dimension", "2", says=["no place for triangles alone"])
        self.expect(2, self.box, "-o", "a.stl", "--dimension", "2", "--order", "2", says=["second order"])
        self.expect(2, self.box, "-o", "a.vtu", "--dimension", "4", says=["--dimension"])

    def test_the_same_bytes(self):
        written = []
        for threads in (1, 2):
            self.expect(0, self.box, "-o", self.out, "--size", "0.1", "--dimension", "2", "--threads", threads,
                        writes=True)
            written.append(self.out.read_bytes())
        self.assertEqual(written[0], written[1])


if __name__ == "__main__":
    unittest.main()
