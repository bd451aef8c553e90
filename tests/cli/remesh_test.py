"""Meshes are adapted on the command line: sizes, names, reports, and errors in inputs.
Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import unittest

from program import BOX_FACES, ProgramTest, box_points, off_text


class Remeshing(ProgramTest):
    def setUp(self):
        super().setUp()
        self.expect(0, self.box, "-o", "first.vtu", "--size", "0.3", "--name", "floor=1", writes=False)

    def report(self, *arguments):
        run = self.run_program("remesh", *arguments, "--report", "r.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads((self.folder / "r.json").read_text())

    def test_a_size_finer_and_coarser(self):
        for size, fewer in ((0.15, False), (0.6, True)):
            report = self.report("first.vtu", "-o", "next.vtu", "--size", size)
            self.assertTrue(report["guarantees_hold"])
            self.assertEqual(report["mesh"]["tets"] < report["remeshing"]["tets_before"], fewer)
            self.assertGreater(report["mesh"]["min_dihedral"], 10)
            self.assertAlmostEqual(sum(report["check"]["region_volumes"].values()), 1, 9)
            self.expect(0, "check", "next.vtu", "--against", self.box)

    def test_names_and_other_formats(self):
        self.expect(0, "remesh", "first.vtu", "-o", "next.msh", "--size", "0.2")
        info = json.loads(self.run_program("info", "next.msh", "--json").stdout)
        self.assertIn("floor", json.dumps(info))
        self.expect(0, "remesh", "next.msh", "-o", "last.inp", "--size", "0.3", "--order", "2")
        self.assertIn("FLOOR", (self.folder / "last.inp").read_text().upper())

    def test_a_field_and_a_page(self):
        field = self.write("field.json", json.dumps(
            {"size": 0.4, "sources": [{"ball": {"centre": [0, 0, 0], "radius": 0.1}, "size": 0.05}]}))
        run = self.run_program("remesh", "first.vtu", "-o", "next.vtu", "--size-field", field, "--report", "r.html",
                               "--report", "r.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("edges divided", run.stderr)
        self.assertIn("<html", (self.folder / "r.html").read_text())
        self.assertGreater(json.loads((self.folder / "r.json").read_text())["remeshing"]["divided_edges"], 100)

    def test_a_smooth_surface(self):
        report = self.report("first.vtu", "-o", "next.vtu", "--size", 0.2, "--smooth-surface")
        self.assertTrue(report["guarantees_hold"] and report["remeshing"]["smooth_surface"])
        run = self.run_program("remesh", "first.vtu", "-o", "next.vtu", "--size", 0.2, "--smooth-surface")
        self.assertIn("moved onto the smooth surface", run.stdout + run.stderr)
        self.expect(2, "remesh", "first.vtu", "-o", "last.vtu", "--smooth-surface", "--against", self.box,
                    says=["smooth-surface", "leave out smooth-surface or that input"])

    def test_against_the_input(self):
        report = self.report("first.vtu", "-o", "next.vtu", "--size", 0.2, "--against", self.box)
        self.assertTrue(report["guarantees_hold"])
        self.expect(0, "check", "next.vtu", "--against", self.box)
        other = self.write("other.off", off_text([[1.5 * c for c in p] for p in box_points()], BOX_FACES))
        self.expect(4, "remesh", "first.vtu", "-o", "last.vtu", "--against", other, says=["does not cover", r"\("])
        self.expect(3, "remesh", "first.vtu", "-o", "last.vtu", "--against", "missing.off", says=["missing.off"])

    def test_the_same_bytes(self):
        written = []
        for threads in (1, 2, 2):
            self.expect(0, "remesh", "first.vtu", "-o", "next.vtu", "--size", "0.2", "--threads", threads)
            written.append((self.folder / "next.vtu").read_bytes())
        self.assertEqual(written[0], written[1])
        self.assertEqual(written[1], written[2])

    def test_what_is_wrong_is_told(self):
        self.expect(3, "remesh", self.box, "-o", "next.vtu", "--size", "0.2",
                    says=["no mesh can be read from a file with the extension"])
        self.expect(3, "remesh", "first.vtk", "-o", "next.vtu", says=["did you mean", "first.vtu"])
        self.expect(2, "remesh", "first.vtu", says=["--output"])
        self.expect(2, "remesh", "first.vtu", "-o", "first.vtu", says=["would overwrite"])
        self.expect(2, "remesh", "first.vtu", "-o", "next.vtu", "--patch-size", "99=0.1", says=["99"])
        self.expect(2, "remesh", "first.vtu", "-o", "next.vtu", "--seed=3", says=["--seed"])
        self.expect(5, "remesh", "first.vtu", "-o", "next.vtu", "--size", "0.01", "--max-vertices", "3000",
                    says=["3000 vertices"])


if __name__ == "__main__":
    unittest.main()
