"""Sizes without effect are reported, and meshes in other units are checked in the input's unit.
Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import unittest

from program import MODELS, ProgramTest


class SizesWithoutEffect(ProgramTest):
    def field(self, *sources):
        return self.write("field.json", json.dumps({"sources": sources}))

    def warnings(self, *arguments):
        run = self.run_program(*arguments, "-o", self.out, "--report", "r.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        told = [line[9:] for line in run.stderr.splitlines() if line.startswith("warning: ")]
        self.assertEqual(told, json.loads((self.folder / "r.json").read_text())["warnings"])
        return told

    def test_sources_of_a_field(self):
        """A size that is too large, one out of reach, and a finer one: only the last one has an effect."""
        ball = {"centre": [0, 0, 0], "radius": 0.1}
        field = self.field({"ball": ball, "size": 0.5}, {"ball": {**ball, "centre": [9, 0, 0]}, "size": 0.01},
                           {"box": {"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}, "size": 0.05, "growth": 1})
        told = self.warnings(self.box, "--size", "0.4", "--size-field", field)
        self.assertEqual(len(told), 2, told)
        self.assertIn("sources[0] (ball)", told[0])
        self.assertIn("sources[1] (ball)", told[1])
        self.assertIn("below 0.4, which --size asks for", told[1])

    def test_a_field_on_a_mesh(self):
        import meshio
        import numpy

        self.run_program(self.box, "-o", "a.vtk", "--size", "1")
        mesh = meshio.read(self.folder / "a.vtk")
        tets = [block for block in mesh.cells if block.type == "tetra"]
        for size, count in ((0.9, 1), (0.1, 0)):
            meshio.Mesh(mesh.points, tets, point_data={"h": numpy.full(len(mesh.points), size)}).write(
                self.folder / "field.vtu")
            told = self.warnings(self.box, "--size", "0.4", "--size-field", "field.vtu")
            self.assertEqual(
                len([text for text in told if "--size-field: the field" in text]), count, told)

    def test_sizes_by_tag(self):
        told = self.warnings(self.box, "--size", "0.4", "--patch-size", "1=0.5", "--patch-size", "2=0.3",
                             "--curve-size", "1=0.4", "--region-size", "1=2")
        self.assertEqual([text.split(": no effect")[0] for text in told],
                         ["--region-size 1=2", "--patch-size 1=0.5", "--curve-size 1=0.4"])

    def test_elements_per_circle(self):
        sphere = MODELS / "sphere.off"
        self.assertIn("nothing here is curved", self.warnings(self.box, "--elements-per-circle", "12")[0])
        self.assertRegex(self.warnings(sphere, "--elements-per-circle", "12")
                         [0], "no effect, as that asks for edges of")
        self.assertEqual(self.warnings(sphere, "--elements-per-circle", "60"), [])


class UnitsOfChecks(ProgramTest):
    def test_check_in_the_unit_of_the_input(self):
        for factor in ("0.001", "25.4"):
            part = MODELS / "bracket.off"
            self.run_program(part, "-o", self.out, "--size", "10", "--scale", factor)
            run = self.run_program("check", self.out, "--against", part)
            self.assertEqual(run.returncode, 7)
            self.assertRegex(run.stdout, rf"note: the mesh is {factor} times as large .* probably {factor}\n")
            run = self.run_program("check", self.out, "--against", part, "--scale", factor)
            self.assertEqual(run.returncode, 0, run.stdout)
            self.assertNotIn("note:", run.stdout)


if __name__ == "__main__":
    unittest.main()
