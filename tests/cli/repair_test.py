"""Inputs that are repaired, and creases.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import math
import unittest

from program import BOX_FACES, COORDINATES, ProgramTest, box_points, off_text, wedge_text


class Repair(ProgramTest):
    """Input that is no valid complex, with all commands."""

    def setUp(self):
        super().setUp()
        self.open_box = self.write("open.off", off_text(box_points(), BOX_FACES[1:]))
        points = box_points() + box_points((0.5, 0.5, 0.5), (2, 2, 2))
        self.overlapping = self.write(
            "overlapping.off", off_text(points, BOX_FACES + [tuple(8 + v for v in face) for face in BOX_FACES]))

    def region_volumes(self, *inputs):
        run = self.expect(0, "info", *inputs, "--json", "--repair", "none")
        return [region["volume"] for region in json.loads(run.stdout)["complex"]["regions"]]

    def test_written_surfaces_are_valid(self):
        for extension in ("stl", "off", "obj", "ply", "om", "poly", "smesh"):
            for model, volume, says in ((self.open_box, 1, "repaired: a hole of 4 edges around"),
                                        (self.overlapping, 4.25, "repaired: .*intersecting facets cut")):
                with self.subTest(model=model.name, format=extension):
                    run = self.expect(0, "repair", model, "-o", f"fixed.{extension}", says=[says, COORDINATES])
                    self.assertNotIn("warning: ", run.stderr)
                    self.assertAlmostEqual(sum(self.region_volumes(f"fixed.{extension}")), volume, places=9)

    def test_valid_input_is_written_as_it_is(self):
        run = self.expect(0, "repair", self.box, "-o", "same.off", says=["valid: nothing had to be repaired"])
        self.assertNotIn("repaired: ", run.stderr)
        self.expect(0, "convert", self.box, "-o", "converted.off")
        self.assertEqual((self.folder / "same.off").read_bytes(), (self.folder / "converted.off").read_bytes())

    def test_several_files_keep_their_regions(self):
        other = self.write("other.off", off_text(box_points((0.5, 0.5, 0.5), (2, 2, 2)), BOX_FACES))
        self.expect(0, "repair", self.box, other, "-o", "both.poly")
        volumes = self.region_volumes("both.poly")
        self.assertEqual(len(volumes), 2)
        self.assertAlmostEqual(volumes[0], 1)
        self.assertAlmostEqual(volumes[1], 1.5**3 - 0.5**3)

    def test_reports(self):
        path = self.folder / "report.json"
        run = self.expect(0, "repair", self.open_box, "-o", "fixed.off", "--json", "--report", path)
        told = json.loads(run.stdout)
        self.assertEqual(told, json.loads(path.read_text()))
        self.assertEqual(told["complex"]["regions"][0]["volume"], 1)
        hole = told["repair"]["filled"][0]
        self.assertEqual((hole["edges"], hole["length"], hole["area"], hole["where"]), (4, 4, 1, [0.5, 0.5, 0]))
        for model, key in ((self.open_box, "filled"), (self.overlapping, "cut"), (self.box, None)):
            with self.subTest(model=model.name):
                self.expect(0, model, "-o", self.out, "--size", "1", "--report", path, writes=True)
                report = json.loads(path.read_text())
                self.assertEqual(report["options"]["repair"], "auto")
                self.assertEqual(report["repair"]["repaired"], key is not None)
                self.assertEqual(bool(report["repair"]["messages"]), key is not None)
                if key:
                    self.assertTrue(report["repair"][key])
        self.assertGreater(len(report["complex"]["regions"]), 0)

    def test_quiet_tells_what_changes_the_shape(self):
        run = self.expect(0, self.open_box, "-o", self.out, "--size", "1", "-q", writes=True)
        self.assertRegex(run.stderr, r"\A\S*open\.off: repaired: a hole [^\n]*\n\Z")
        run = self.expect(0, "repair", self.overlapping, "-o", "fixed.off", "-q", writes=True)
        self.assertNotIn("cut", run.stderr)
        self.assertIn("removed", run.stderr)

    def test_info_and_check_tell_it(self):
        self.expect(0, self.overlapping, "-o", self.out, "--size", "0.5", writes=True)
        run = self.expect(0, "info", self.overlapping, writes=True, says=["repaired: ", "1 region"])
        run = self.expect(0, "info", self.overlapping, "--json", writes=True)
        self.assertTrue(json.loads(run.stdout)["repair"]["repaired"])
        self.expect(0, "check", self.out, "--against", self.overlapping, writes=True,
                    says=["note: the input was repaired: ", "every guarantee holds"])
        run = self.expect(0, "check", self.out, "--against", self.overlapping, "--json", writes=True)
        self.assertTrue(any("repaired" in note for note in json.loads(run.stdout)["notes"]))
        self.expect(4, "check", self.out, "--against", self.overlapping, "--repair", "none", writes=True)
        self.expect(4, "info", self.overlapping, "--repair", "none", writes=True)

    def test_convert_repairs_on_request(self):
        self.expect(0, "convert", self.overlapping, "-o", "same.off")
        self.assertEqual((self.folder / "same.off").read_text().split()[1:3], ["16", "12"])
        self.expect(0, "convert", self.overlapping, "-o", "same.off", "--repair", "none")
        self.assertEqual((self.folder / "same.off").read_text().split()[1:3], ["16", "12"])
        self.expect(0, "convert", self.overlapping, "-o", "fixed.off", "--repair", "auto", says=["repaired: "])
        self.assertAlmostEqual(sum(self.region_volumes("fixed.off")), 4.25)

    def test_a_surface_around_everything(self):
        sheet = self.write("sheet.off", off_text(box_points()[:4], BOX_FACES[:1]))
        path = self.folder / "report.json"
        self.expect(0, sheet, "-o", self.out, "--repair", "wrap", "--report", path, writes=True,
                    says=["repaired: a closed surface was wrapped around everything"])
        report = json.loads(path.read_text())
        self.assertTrue(report["repair"]["wrapped"])
        offset = 5e-3 * math.sqrt(2)
        self.assertAlmostEqual(report["repair"]["largest_distance"], offset, delta=0.1 * offset)
        self.assertGreater(report["check"]["region_volumes"]["1"], 2 * 0.8 * offset)
        self.expect(0, "check", self.out, "--against", sheet, "--repair", "wrap", writes=True)
        self.out.unlink()
        self.expect(0, self.open_box, "-o", self.out, "--repair", "wrap", "--report", path, writes=True)
        self.assertFalse(json.loads(path.read_text())["repair"]["wrapped"], "not where holes can be filled")

    def test_mistakes(self):
        self.expect(2, "repair", self.box, "-o", "out.vtu", says=["out.vtu", r"\.stl", r"\.poly"])
        self.expect(2, "repair", self.box, "-o", "-", "--format", "off", "--json", says=["--report"])
        self.expect(2, "repair", self.box, says=["--output is required; write collarmesh repair IN... -o OUT"])
        self.expect(2, "repair", self.box, "-o", "a.off", "--report", "a.off", says=["--output"])
        self.expect(2, self.box, "-o", self.out, "--repair", "maybe", says=["--repair"])
        self.expect(3, "repair", "missing.off", "-o", "a.off", says=["no such file"])
        self.expect(8, "repair", self.box, "-o", "missing/a.off", says=["does not exist"])


class Creases(ProgramTest):
    def test_a_sharp_wedge_gets_collars(self):
        report = self.folder / "report.json"
        wedge = self.write("wedge.off", wedge_text(10))
        self.expect(0, wedge, "-o", self.out, "--coarsen", "off", "--report", report, writes=True)
        found = json.loads(report.read_text())
        self.assertGreater(len(found["complex"]["creases"]), 0)
        self.assertGreater(found["check"]["collar_tets"], 0)
        self.assertEqual(found["check"]["thin_tets"], 0)
        self.assertIsNone(found["coarsening"])
        self.expect(0, "check", self.out, "--against", wedge, writes=True)

    def test_bounds_that_coarsening_does_not_keep(self):
        wedge = self.write("wedge.off", wedge_text(40))
        for coarsen, warns in (("on", True), ("off", False)):
            with self.subTest(coarsen=coarsen):
                run = self.expect(0, wedge, "-o", self.out, "--vertex-ratio", "6", "--coarsen", coarsen, writes=True)
                warning = [line for line in run.stderr.splitlines() if line.startswith("warning: --vertex-ratio")]
                self.assertEqual(["--coarsen off" in line for line in warning], [True] if warns else [])

    def test_bounds_that_coarsening_keeps(self):
        wedge = self.write("wedge.off", wedge_text(20))
        report = self.folder / "report.json"
        for option, value in (("--collar-angle", "115"), ("--radius-edge", "1.6")):
            with self.subTest(option=option):
                run = self.expect(0, wedge, "-o", self.out, option, value, "--report", report, writes=True)
                check = json.loads(report.read_text())["check"]
                self.assertGreater(check["collar_tets"], 0)
                self.expect(0, "check", self.out, "--against", wedge, option, value, writes=True)
                self.assertNotIn("every guarantee holds", self.expect(
                    7, "check", self.out, "--against", wedge, "--collar-angle", "100", writes=True).stdout)
        self.assertLessEqual(check["max_radius_edge"], 1.6)
        self.assertIn("warning: --collar-angle 115: collars may miss bounds",
                      self.run_program(wedge, "-o", self.out, "--collar-angle", "115").stderr)
        # Without a crease there is no collar.
        run = self.expect(0, self.box, "-o", self.out, "--collar-angle", "115", writes=True)
        self.assertNotIn("warning", run.stderr)

    def test_a_sharp_wedge_gets_thin_tets_in_the_place_of_many(self):
        wedge = self.write("wedge.off", wedge_text(5))
        tets = {}
        for coarsen in ("on", "off"):
            report = self.folder / "report.json"
            self.expect(0, wedge, "-o", self.out, "--coarsen", coarsen, "--report", report, writes=True)
            found = json.loads(report.read_text())
            tets[coarsen] = found["mesh"]["tets"]
            self.assertEqual(found["check"]["thin_tets"] > 0, coarsen == "on")
            self.expect(0, "check", self.out, "--against", wedge, writes=True)
            strict = self.run_program("check", self.out, "--against", wedge, "--thin-angle", "0", "--json")
            guarantees = {finding["guarantee"] for finding in json.loads(strict.stdout)["findings"]}
            self.assertEqual(guarantees, {"radius_edge"} if coarsen == "on" else set())
        self.assertLess(tets["on"], 0.4 * tets["off"])
        self.out.unlink()
        for word, value in (("--coarsen", "maybe"), ("--thin-angle", "31")):
            self.expect(2, wedge, "-o", self.folder / "other.vtu", word, value, says=[word])

    def test_the_bound_in_collars_is_an_option(self):
        wedge = self.write("wedge.off", wedge_text(30))
        self.expect(0, wedge, "-o", self.out, "--coarsen", "off", "--collar-angle", "140", writes=True)
        self.expect(0, "check", self.out, "--against", wedge, "--collar-angle", "140", writes=True)
        self.expect(7, "check", self.out, "--against", wedge, "--collar-angle", "100", writes=True)
        self.out.unlink()
        self.expect(2, self.box, "-o", self.out, "--collar-angle", "99", says=["100 to 175"])


if __name__ == "__main__":
    unittest.main()
