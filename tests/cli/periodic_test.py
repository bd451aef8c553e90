"""Periodic faces: options, messages, reports, files."""

import json
import re
import unittest

from program import BOX_FACES, ProgramTest, box_points, off_text


class Periodic(ProgramTest):
    PAIRS = ("--periodic", "x", "--periodic", "y", "--periodic", "z")

    def setUp(self):
        super().setUp()
        self.cell = self.write("cell.off", off_text(box_points((0, 0, 0), (1, 1, 1)), BOX_FACES))

    def test_pairs_are_told_and_reported(self):
        report, out = self.folder / "r.json", self.folder / "cell.msh"
        for order in ("1", "2"):
            run = self.run_program(self.cell, "-o", out, "--size", "0.3", "--order",
                                   order, *self.PAIRS, "--report", report)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("every guarantee holds", run.stderr)
            told = re.findall(r"periodic ([xyz]): (\d+) nodes, (\d+) triangles map onto their images; largest gap "
                              r"(\S+)\n",
                              run.stderr)
            self.assertEqual([each[0] for each in told], ["x", "y", "z"])
            read = json.loads(report.read_text())
            self.assertEqual(read["options"]["periodic"], ["x", "y", "z"])
            for axis, (each, pair) in enumerate(zip(told, read["periodic"]["pairs"])):
                self.assertEqual((pair["text"], pair["nodes"], pair["triangles"]),
                                 (each[0], int(each[1]), int(each[2])))
                self.assertEqual(len(pair["node_pairs"]), pair["nodes"])
                self.assertLess(pair["largest_gap"], 1e-14)
                self.assertEqual(pair["shift"], [float(k == axis) for k in range(3)])
            self.assertIn("$Periodic", out.read_text())
            checked = self.run_program("check", out, "--against", self.cell)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_a_sector_turns_about_its_axis(self):
        points = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (0, 1))]
        sector = self.write("sector.off", off_text(
            points, [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]))
        out = self.folder / "sector.inp"
        for order in ("1", "2"):
            run = self.run_program(sector, "-o", out, "--size", "0.3", "--order", order, "--periodic",
                                   "3=5:rotation,z,90", "--periodic", "z")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertRegex(run.stderr, r"periodic 3=5:rotation,z,90: \d+ nodes")
            text = (self.folder / "sector_periodic.inp").read_text()
            self.assertIn("*NSET, NSET=PERIODIC_1_AXIS", text)

    def test_conditions_lie_beside_inp(self):
        run = self.run_program(self.cell, "-o", self.folder / "cell.inp", "--size", "0.3", *self.PAIRS)
        self.assertEqual(run.returncode, 0, run.stderr)
        text = (self.folder / "cell_periodic.inp").read_text()
        self.assertEqual(len(re.findall(r"PERIODIC_\d_REFERENCE", text)), 3)
        self.assertIn("*EQUATION", text)

    def test_nothing_changes_without_it(self):
        report, out = self.folder / "r.json", self.folder / "cell.inp"
        self.assertEqual(self.run_program(self.cell, "-o", out, "--report", report).returncode, 0)
        self.assertIsNone(json.loads(report.read_text())["periodic"])
        self.assertFalse((self.folder / "cell_periodic.inp").exists())

    def test_the_file_beside_is_no_input(self):
        cell = self.write("cell_periodic.inp", "")
        self.expect(2, self.cell, "-o", self.folder / "cell.inp", "--size-field", cell, says=["would overwrite"])

    def test_mistakes_come_before_the_work(self):
        self.expect(2, self.cell, "-o", self.out, "--periodic", "x",
                    "--keep-apart", says=["the copies would have no images"])
        for pair in ("w", "1=", "1=9", "1=2:rotation,z", "1=2:translation,0,0,0.5"):
            self.expect(2, self.cell, "-o", self.out, "--periodic", pair, says=[pair])


if __name__ == "__main__":
    unittest.main()
