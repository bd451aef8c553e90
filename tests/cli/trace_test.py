"""Traces of runs: a series of files that VTK's readers read, whose last step is the mesh.

Run by ctest with COLLARMESH_PROGRAM set.
"""

import hashlib
import json
import unittest
import xml.etree.ElementTree

try:
    import meshio
    import numpy
except ImportError:
    meshio = None

from program import ProgramTest, wedge_text

TET, PATCH, COLLAR_SURFACE, SEGMENT, BALL = range(5)
OUTSIDE, REGION, RIPPED, STAR, BOOK, THIN = range(6)
MOST_STEPS = 24


class TraceTest(ProgramTest):
    def trace(self, part, *options, code=0):
        """Runs the program; returns the names of the steps and the report."""
        run = self.run_program(part, "-o", self.out, "--trace", "steps", "--report", "report.json", *options)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assert_nothing_left()
        self.assertEqual([p.name for p in (self.folder / "steps").iterdir() if p.name.startswith(".")], [])
        root = xml.etree.ElementTree.parse(self.folder / "steps/trace.pvd").getroot()
        self.assertEqual(root.get("type"), "Collection")
        entries = list(root.iter("DataSet"))
        self.assertEqual([float(entry.get("timestep")) for entry in entries], list(range(len(entries))))
        names = [entry.get("file") for entry in entries]
        self.assertLessEqual(len(names), MOST_STEPS)
        self.assertEqual(sorted(names), sorted(p.name for p in (self.folder / "steps").glob("*.vtu")))
        return names, json.loads((self.folder / "report.json").read_text())

    def read(self, name):
        """Returns values by kind of cell, and the coordinates."""
        step = meshio.read(self.folder / "steps" / name)
        data = {key: numpy.concatenate(values) for key, values in step.cell_data.items()}
        return step, data


@unittest.skipUnless(meshio, "meshio is not installed")
class Steps(TraceTest):
    def test_the_last_step_is_the_mesh(self):
        for options, last in ((("--size", "0.3"), "improve"), (("--size", "0.3", "--improve", "0"), "coarsen"),
                              (("--size", "0.3", "--improve", "0", "--coarsen", "off"), "stitch")):
            with self.subTest(options=options):
                for old in (self.folder / "steps").glob("*"):
                    old.unlink()
                names, report = self.trace(self.write("wedge.off", wedge_text(25)), *options)
                stages = [name[3:-4] for name in names]
                self.assertEqual(stages[0], "box")
                self.assertEqual(stages[-1], last)
                self.assertLess(stages.index("refine"), stages.index("rip"))
                _, data = self.read(names[-1])
                self.assertEqual((data["kind"] == TET).sum(), report["mesh"]["tets"])
                self.assertAlmostEqual(data["min_dihedral"][data["kind"] == TET].min(),
                                       report["mesh"]["min_dihedral"], places=3)

    def test_what_is_ripped_out_is_stitched(self):
        names, _ = self.trace(self.write("wedge.off", wedge_text(25)), "--size", "0.3")
        by_stage = {name[3:-4]: self.read(name) for name in names}
        step, before = by_stage["rip"]
        after = by_stage["stitch"][1]
        self.assertGreater((before["state"] == RIPPED).sum(), 0)
        self.assertGreater((before["kind"] == COLLAR_SURFACE).sum(), 0)
        self.assertFalse(numpy.isin(before["state"], (STAR, BOOK)).any())
        self.assertFalse((after["state"] == RIPPED).any())
        self.assertGreater((after["state"] == STAR).sum(), 0)
        self.assertGreater((after["state"] == BOOK).sum(), 0)
        of_tets = before["state"][before["kind"] == TET]
        self.assertEqual((of_tets == REGION).sum(), (after["state"] == REGION).sum())
        # The wedge's crease is the line x = y = 0; each ball of a collar has the reason why it was placed.
        balls = numpy.concatenate([block.data[:, 0] for block in step.cells if block.type == "vertex"])
        reasons = before["reason"][before["kind"] == BALL]
        self.assertEqual(len(balls), len(reasons))
        of_collars = step.points[balls[reasons > 1]]
        self.assertGreater(len(of_collars), 2)
        self.assertLess(abs(of_collars[:, :2]).max(), 1e-9)
        self.assertTrue((step.point_data["radius"][balls] > 0).all())

    def test_steps_double_until_they_are_large(self):
        names, _ = self.trace(self.box, "--size", "0.12", "--coarsen", "off")
        counts = [len(self.read(name)[0].points) for name in names if name[3:-4] == "refine"]
        self.assertGreater(len(counts), 5)
        for less, more in zip(counts, counts[1:]):
            self.assertGreater(more, 1.3 * less)


class Files(TraceTest):
    def test_the_mesh_is_the_same(self):
        part = self.write("wedge.off", wedge_text(25))
        meshes = []
        for options in ((), ("--trace", "steps")):
            self.assertEqual(self.run_program(part, "-o", self.out, "--size", "0.3", *options).returncode, 0)
            meshes.append(hashlib.sha256(self.out.read_bytes()).digest())
        self.assertEqual(*meshes)

    def test_a_run_that_ends_early_leaves_its_steps(self):
        names, _ = self.trace(self.box, "--size", "0.05", "--max-vertices", "500", code=5)
        self.assertEqual(names[0], "00_box.vtu")
        self.assertGreater(len(names), 3)
        self.assertFalse(self.out.exists())

    def test_folders_that_cannot_be(self):
        self.expect(8, self.box, "-o", self.out, "--trace", "missing/steps", says=["missing/steps: cannot be made"])
        self.write("taken", "text")
        self.expect(8, self.box, "-o", self.out, "--trace", "taken", says=["taken"])
        self.expect(2, self.box, "--batch", "many", "--trace", "steps", says=["--batch.*--trace"])


if __name__ == "__main__":
    unittest.main()
