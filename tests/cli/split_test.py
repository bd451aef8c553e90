"""Internal patches with separate nodes on each side: options, messages, reports."""

import json
import sys
import unittest

from program import BOX_FACES, MODELS, SOURCES, ProgramTest, box_points, off_text

sys.path.append(str(SOURCES / "tests/support"))
from step_file import StepFile  # noqa: E402


class Splitting(ProgramTest):
    def setUp(self):
        super().setUp()
        self.crack = MODELS / "cracked_box.poly"

    def two_boxes(self):
        return [self.write(f"{k}.off", off_text(box_points((k, 0, 0), (k + 1, 1, 1)), BOX_FACES)) for k in range(2)]

    def test_a_crack_is_told_and_reported(self):
        report = self.folder / "r.json"
        run = self.expect(0, self.crack, "-o", self.out, "--size", "0.3", "--patch-size", "7=0.1", "--split", "crack",
                          "--name", "crack=7", "--report", report, writes=True)
        self.assertRegex(run.stderr, r"split: crack into patches \d+ and \d+, \d+ triangles each, area 0\.\d+, at \(")
        self.assertIn("every guarantee holds", run.stderr)
        read = json.loads(report.read_text())
        self.assertEqual(read["options"]["split"], ["crack"])
        split = read["split"]
        patch = split["patches"][0]
        self.assertEqual((patch["tag"], patch["name"]), (7, "crack"))
        self.assertEqual(patch["minus"] == 7, patch["closed_triangles"] == 0)
        self.assertEqual(split["new_nodes"], split["split_nodes"])
        self.assertGreater(split["front_nodes"], 0)
        names = self.run_program("info", self.out).stdout
        self.assertIn("crack_minus", names)
        self.assertIn("crack_plus", names)

    def test_nothing_changes_without_it(self):
        self.assertEqual(json.loads(self.report_of(self.box))["split"], None)

    def report_of(self, *arguments):
        report = self.folder / "r.json"
        self.assertEqual(self.run_program(*arguments, "-o", self.out, "--report", report).returncode, 0)
        return report.read_text()

    def test_unknown_names_come_before_the_work(self):
        self.expect(2, self.crack, "-o", self.out, "--split", "cracks",
                    says=["no patch is called 'cracks'; only internal patches can be split: 7"])
        self.expect(2, self.crack, "-o", self.out, "--split", "1", says=["patch '1' lies on the boundary"])
        self.expect(2, self.box, "-o", self.out, "--keep-apart", says=["no two regions touch"])
        self.expect(2, self.box, "-o", self.out, "--cohesive", says=["add split or keep-apart"])

    def test_other_formats_have_no_place_for_ties(self):
        for option in (("--interaction", "tie"), ("--cohesive",)):
            run = self.run_program(*self.two_boxes(), "-o", self.out, "--keep-apart", *option)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn("write .inp", run.stderr)
            self.assertFalse(self.out.exists())

    def test_what_is_between_the_sides_in_inp(self):
        out = self.folder / "a.inp"
        for order in ("1", "2"):
            run = self.run_program(*self.two_boxes(), "-o", out, "--size", "0.5", "--keep-apart", "--interaction",
                                   "contact", "--cohesive", "--order", order)
            self.assertEqual(run.returncode, 0, run.stderr)
            text = out.read_text()
            self.assertRegex(text, r"\*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\n"
                             r"PATCH_\d+_PLUS, PATCH_\d+_MINUS\n")
            block = text.split("*ELEMENT, TYPE=COH3D6, ELSET=COHESIVE_PATCH_", 1)[1].split("\n*", 1)[0].splitlines()[1:]
            prisms = [[int(word) for word in line.split(",")] for line in block]
            rows = text.split("*NODE, NSET=NALL\n", 1)[1].split("*", 1)[0].splitlines()
            place = {int(row.split(",")[0]): row.split(",", 1)[1] for row in rows}
            for _, a, b, c, p, q, r in prisms:
                self.assertEqual([place[a], place[b], place[c]], [place[p], place[q], place[r]])
                self.assertEqual(len({a, b, c, p, q, r}), 6)
            numbers = [row[0] for row in prisms]
            self.assertEqual(len(set(numbers)), len(numbers))

    def test_solids_of_a_step_file_are_kept_apart(self):
        file = StepFile()
        file.product("Left", file.box((0, 0, 0), (1, 1, 1)))
        file.product("Right", file.box((1, 0, 0), (2, 1, 1)))
        part = file.write(self.folder / "part.step")
        run = self.run_program(part, "-o", self.out, "--size", "0.5", "--keep-apart", "--order", "2")
        if "OpenCASCADE" in run.stderr:
            self.skipTest("no OpenCASCADE")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, r"split: Face2 into patches 2 and \d+, ")
        self.assertIn("every guarantee holds", run.stderr)


if __name__ == "__main__":
    unittest.main()
