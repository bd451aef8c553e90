"""Results: guarantees, files, reports.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import math
import os
import re
import subprocess
import unittest

from program import BOX_FACES, COORDINATES, MODELS, PROGRAM, ProgramTest, box_points, off_text, wedge_text


class Guarantees(ProgramTest):
    def test_mesh_and_check_in_every_format(self):
        for extension in ("vtu", "msh", "mesh"):
            with self.subTest(format=extension):
                mesh = self.folder / f"mesh.{extension}"
                self.assertEqual(self.run_program(self.box, "-o", mesh, "--size", "0.2").returncode, 0)
                run = self.run_program("check", mesh, "--against", self.box)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                self.assertIn("every guarantee holds", run.stdout)

    def test_check_finds_what_is_missed(self):
        self.expect(0, self.box, "-o", self.out, "--size", "0.2", writes=True)
        run = self.expect(7, "check", self.out, "--against", self.box, "--radius-edge", "1", writes=True)
        self.assertRegex(run.stdout, COORDINATES)
        larger = self.write("larger.off", off_text(box_points(high=(1, 1, 1.5)), BOX_FACES))
        run = self.expect(7, "check", self.out, "--against", larger, "--json", writes=True)
        report = json.loads(run.stdout)
        self.assertFalse(report["passed"])
        self.assertGreater(len(report["findings"]), 0)
        self.assertTrue(all(f["message"] and len(f["where"]) == 3 for f in report["findings"]))

    def test_where_all_tets_are_thin_no_ratio_of_others_is_told(self):
        plate = self.write("plate.off", off_text(box_points(high=(30, 30, 0.2)), BOX_FACES))
        run = self.expect(0, plate, "-o", self.out, "--size", "6", writes=True)
        self.assertRegex(run.stderr, r"degrees, all tets thin or in collars \(radius-edge of thin tets \d+")

    def test_a_mesh_that_misses_a_guarantee_is_written(self):
        """A segment leaves a corner at a small angle, without a collar, so edges there become ever shorter."""
        points = box_points() + [(0.5, 0.05, 0.05)]
        lines = [f"{len(points)} 3 0 0", *(f"{k} {p[0]} {p[1]} {p[2]}" for k, p in enumerate(points)),
                 f"{len(BOX_FACES) + 1} 0"]
        lines += [f"1\n{len(f)} " + " ".join(map(str, f)) for f in (*BOX_FACES, (0, 8))]
        model = self.write("segment.poly", "\n".join([*lines, "0", "0"]) + "\n")
        report = self.folder / "report.json"
        run = self.expect(7, model, "-o", self.out, "--crease-angle", "0", "--report", report, writes=True)
        self.assertRegex(run.stderr, "collarmesh: a guarantee is missed: .*near " +
                         COORDINATES.pattern + ".*crease-angle")
        found = json.loads(report.read_text())
        self.assertEqual((found["status"], found["guarantees_hold"]), ("guarantee_missed", False))
        self.assertEqual(self.run_program("info", self.out).returncode, 0)
        self.out.unlink()
        self.expect(0, model, "-o", self.out, writes=True)

    def test_a_failed_run_writes_its_report(self):
        """Runs stopped by a budget, the input or an option leave no mesh, and replace an earlier report."""
        tilted = self.write("open.off", off_text(box_points(), BOX_FACES[:3]))
        for code, status, stage, arguments in (
                (5, "budget_hit", "refine", [self.box, "--size", "0.01", "--max-vertices", "500"]),
                (5, "budget_hit", None, [self.box, "--size", "0.002", "--time-limit", "0.5"]),
                (3, "unreadable", "read", ["missing.off"]),
                (4, "invalid_complex", "complex", [tilted, "--repair", "none"]),
                (2, "usage", "complex", [self.box, "--patch-size", "99=0.1"])):
            with self.subTest(arguments=arguments):
                report = self.write("report.json", "of an earlier run")
                page = self.folder / "page.html"
                run = self.expect(code, *arguments, "-o", self.out, "--report", report, "--report", page)
                found = json.loads(report.read_text())
                self.assertEqual((found["status"], found["exit_code"], found["guarantees_hold"]), (status, code, False))
                self.assertIn(found["message"].splitlines()[0], run.stderr)
                if stage is not None:
                    self.assertEqual(found["stage"], stage)
                if "--max-vertices" in arguments:
                    self.assertGreater(found["reached"]["vertices"], 0)
                if status == "invalid_complex":
                    self.assertEqual(len(found["faults"][0]["where"]), 3)
                self.assertEqual(found["output"], str(self.out))
                self.assertIn(f"exit code {code}", page.read_text())

    def test_quiet_runs_say_which_file_is_meant(self):
        sphere = MODELS / "sphere.off"
        run = self.run_program(sphere, "-o", self.out, "--size", "1", "--distance", "0.3", "--order", "2", "-q",
                               "--elements-per-circle", "3")
        for line in run.stderr.splitlines():
            self.assertRegex(line, f"^({self.out}|{sphere}): ")
        self.assertNotEqual(run.stderr, "")

    def test_region_volumes_are_exact(self):
        report = self.folder / "report.json"
        self.expect(0, MODELS / "two_boxes.poly", "-o", self.out, "--report", report, writes=True)
        volumes = json.loads(report.read_text())["check"]["region_volumes"]
        self.assertAlmostEqual(volumes["1"], 2, places=12)
        self.assertAlmostEqual(volumes["2"], 1, places=12)

    def test_several_files_are_one_complex(self):
        other = self.write("other.off", off_text(box_points((1, 0, 0), (2, 1, 1)), BOX_FACES))
        self.expect(0, self.box, other, "-o", self.out, "--size", "0.3", writes=True)
        run = self.run_program("info", self.box, other, "--json")
        self.assertEqual([r["volume"] for r in json.loads(run.stdout)["complex"]["regions"]], [1, 1])

    def test_sample_models(self):
        for model in sorted(MODELS.iterdir()):
            with self.subTest(model=model.name):
                run = self.run_program(model, "-o", self.out)
                self.assertEqual(run.returncode, 0, run.stderr)


class Writing(ProgramTest):
    def test_missing_folder_is_told_before_reading(self):
        self.expect(8, "no_such_file.off", "-o", self.folder / "no" / "out.vtu", says=["does not exist"])
        self.expect(8, self.box, "-o", self.out, "--report", self.folder / "no" / "r.json", says=["does not exist"])

    def test_folder_in_the_way(self):
        (self.folder / "taken.vtu").mkdir()
        self.expect(8, self.box, "-o", self.folder / "taken.vtu", says=["is a folder"])

    def test_file_in_the_way(self):
        self.expect(8, self.box, "-o", self.box / "out.vtu", says=["not a folder"])

    def test_unwritable_folder(self):
        locked = "/proc" if os.geteuid() == 0 else self.folder / "locked"
        if os.geteuid() != 0:
            locked.mkdir(mode=0o555)
        self.expect(8, self.box, "-o", f"{locked}/out.vtu", says=["cannot write"])

    def test_replaces_a_file_from_before(self):
        self.out.write_text("old")
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", writes=True)
        self.assertGreater(self.out.stat().st_size, 100)


class Reports(ProgramTest):
    def test_report(self):
        path = self.folder / "report.json"
        self.expect(0, self.box, "-o", self.out, "--size", "0.2", "--seed", "5", "--report", path, writes=True)
        report = json.loads(path.read_text())
        self.assertEqual(report["inputs"], [str(self.box)])
        self.assertEqual((report["options"]["size"], report["options"]["seed"]), (0.2, 5))
        self.assertTrue(report["guarantees_hold"] and report["check"]["passed"])
        self.assertAlmostEqual(report["check"]["region_volumes"]["1"], 1, places=12)
        self.assertEqual(report["mesh"]["tets"], report["check"]["tets"])
        self.assertEqual(sum(report["mesh"]["histograms"]["radius_edge"]["tets"]), report["mesh"]["tets"])
        self.assertLessEqual(report["mesh"]["max_radius_edge"], 2)
        self.assertGreater(report["seconds"]["total"], 0)
        self.assertEqual(report["complex"]["curves"], 12)

    def test_report_in_place_of_another_file(self):
        before = self.box.read_bytes()
        link = self.folder / "link.json"
        link.symlink_to(self.box)
        for path in (self.box, self.folder / "." / self.box.name, link):
            self.expect(2, self.box, "-o", self.out, "--report", path, says=["input"])
        self.expect(2, self.box, "-o", self.out, "--report", self.folder / "." / self.out.name, says=["--output"])
        self.assertEqual(self.box.read_bytes(), before)
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        self.expect(8, self.box, "-o", self.out, "--report", pipe, says=["not a regular file"])
        self.assertTrue(pipe.is_fifo(), "the report of the failure replaced it")

    def test_warnings_of_the_input(self):
        model = self.write("two.poly", (MODELS / "two_boxes.poly").read_text())
        text = model.read_text()
        path = self.folder / "report.json"
        self.expect(0, model, "-o", self.out, "--report", path, writes=True)
        self.assertEqual(json.loads(path.read_text())["complex"]["warnings"], [])
        lines = text.rstrip().splitlines()
        at = max(k for k, line in enumerate(lines) if line.split() == [
                 "2"] or line.split()[:1] == ["2"] and len(line.split()) == 1)
        lines[at] = "3"
        outside = self.write("outside.poly", "\n".join([*lines, "3 70 0 0 5"]) + "\n")
        run = self.expect(0, outside, "-o", self.out, "-q", "--report", path, writes=True)
        self.assertRegex(run.stderr, r"^warning: .*outside\.poly: the region point \(70, 0, 0\) lies outside")
        warnings = json.loads(path.read_text())["complex"]["warnings"]
        self.assertEqual([w["where"] for w in warnings], [[70, 0, 0]])
        self.assertIn("warning: ", self.expect(0, "info", outside, writes=True).stdout)

    def test_lines_outside_of_every_region_are_told(self):
        """Only this warning says that the mesh does not contain the lines."""
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)] + [(2, 0.5, 0.5), (3, 0.5, 0.5)]
        sides = ["1 2 4 3", "5 6 8 7", "1 2 6 5", "3 4 8 7", "1 3 7 5", "2 4 8 6"]
        points = "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(corners, 1))
        facets = "".join(f"1 0 {i}\n4 {side}\n" for i, side in enumerate(sides, 1)) + "1 0 77\n2 9 10\n"
        wire = self.write("wire.poly", f"10 3 0 0\n{points}7 1\n{facets}0\n0\n")
        run = self.expect(0, wire, "-o", self.out, "--size", "0.5", writes=True)
        self.assertRegex(
            run.stderr, r"warning: Curves outside .* 1 in all, of which the first is .* \(tag 77\) at \(2, 0.5, 0.5\)")

    def test_a_link_is_followed(self):
        named, link = self.folder / "named.json", self.folder / "link.json"
        named.write_text("old")
        link.symlink_to(named)
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", "--report", link, writes=True)
        self.assertTrue(link.is_symlink())
        self.assertTrue(json.loads(named.read_text())["guarantees_hold"])
        self.out.unlink()
        self.expect(5, self.box, "-o", self.out, "--size", "0.02", "--max-vertices", "100", "--report", link)
        self.assertTrue(link.is_symlink())
        self.assertFalse(json.loads(named.read_text())["guarantees_hold"])

    def test_info(self):
        run = self.expect(0, "info", self.box)
        for text in ("8 vertices", "12 curves", "6 patches", "volume 1", "no creases"):
            self.assertIn(text, run.stdout)
        complex_ = json.loads(self.expect(0, "info", self.box, "--json").stdout)["complex"]
        self.assertEqual((complex_["vertices"], complex_["patches"], complex_["smallest_angle"]), (8, 6, 90))
        wedge = json.loads(self.expect(0, "info", self.write("wedge.off", wedge_text(30)), "--json").stdout)["complex"]
        self.assertAlmostEqual(wedge["creases"][0]["angle"], 30, places=6)

    def test_info_of_a_mesh(self):
        self.expect(0, self.box, "-o", self.out, "--size", "0.3", writes=True)
        mesh = json.loads(self.expect(0, "info", self.out, "--json", writes=True).stdout)["mesh"]
        self.assertAlmostEqual(sum(mesh["region_volumes"].values()), 1, places=12)
        self.assertIn("tets", self.expect(0, "info", self.out, writes=True).stdout)

    def predictions(self, *arguments):
        return json.loads(self.expect(0, "info", *arguments, "--json").stdout)["predictions"]

    def test_predictions_are_near_the_meshes(self):
        predicted = self.predictions(self.box, "--predict", "0.2,0.1,0")
        self.assertEqual([p["size"] for p in predicted[:2]], [0.2, 0.1])
        self.assertAlmostEqual(predicted[2]["size"], math.sqrt(3) / 20)
        self.assertTrue(all(p["seconds"] > 0 for p in predicted))
        for p in predicted[:2]:
            report = self.folder / "report.json"
            self.run_program(self.box, "-o", self.out, "--size", p["size"], "--report", report)
            made = json.loads(report.read_text())["mesh"]["tets"]
            self.assertLess(abs(p["tets"] - made), 0.25 * made, p)

    def test_predictions_heed_the_options_of_sizes(self):
        def tets(*options):
            return self.predictions(self.box, "--predict", "0.2", *options)[0]["tets"]

        plain = tets()
        ball = {"centre": [0, 0, 0], "radius": 0.3}
        field = self.write("field.json", json.dumps({"sources": [{"ball": ball, "size": 0.05}]}))
        for finer in (("--patch-size", "1=0.05"), ("--curve-size", "1=0.01"), ("--region-size", "1=0.1"),
                      ("--size-field", field)):
            self.assertGreater(tets(*finer), 1.2 * plain, finer)
        fine_side = ("--patch-size", "1=0.05")
        self.assertGreater(tets(*fine_side, "--gradation", "0.1"), 1.5 * tets(*fine_side))
        self.assertEqual(self.predictions(self.box, "--size", "0.5", "--predict", "0")[0]["size"], 0.5)
        sphere = MODELS / "sphere.off"
        coarse = 3 * self.predictions(sphere, "--predict", "0")[0]["size"]
        straight, curved = (self.predictions(sphere, "--predict", coarse,
                            "--order", order)[0]["tets"] for order in "12")
        self.assertLess(curved, straight)  # curved elements need no small triangles to keep the volume
        near = self.predictions(sphere, "--predict", coarse, "--distance", coarse / 500)[0]["tets"]
        self.assertGreater(near, straight)

    def test_predictions_are_told_one_by_one(self):
        """Predictions come in the order of the sizes, each before the program begins the next one."""
        sizes = [0.1, 0.4, 0.2, 0.05]
        asked = ("--predict", ",".join(map(str, sizes)), "--progress", "json")
        run = self.expect(0, "info", self.box, *asked, "--json")
        told = [json.loads(line)["prediction"] for line in run.stderr.splitlines()]
        self.assertEqual([each["size"] for each in told], sizes)
        self.assertEqual(told, json.loads(run.stdout)["predictions"])
        self.assertEqual(self.expect(0, "info", self.box, *asked[:2]).stderr, "")

    def test_predictions_do_not_wait_for_the_others(self):
        """If the program is ended after the first prediction, it has not printed all."""
        many = ",".join(str(0.01 + i / 1e5) for i in range(50))
        with subprocess.Popen([PROGRAM, "info", self.box, "--predict", many, "--progress", "json"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as run:
            first = json.loads(run.stderr.readline())["prediction"]
            run.kill()
            others = run.stderr.read().splitlines()
        self.assertEqual(first["size"], 0.01)
        self.assertLess(len(others), 49)

    def test_predictions_as_text(self):
        told = self.expect(0, "info", self.box, "--predict", "0.5,0.25").stdout
        rows = re.findall(r"^ +(0\.\d+) +(\d+) +[\d.e-]+$", told, re.M)
        self.assertEqual([size for size, _ in rows], ["0.5", "0.25"])
        self.assertGreater(int(rows[1][1]), int(rows[0][1]))
        self.assertNotIn("estimates", self.expect(0, "info", self.box).stdout)
        self.assertNotIn("predictions", self.expect(0, "info", self.box, "--json").stdout)

    def test_predictions_beyond_every_integer(self):
        sizes = "1e-8,1e-14,1e-120"
        told = self.predictions(self.box, "--predict", sizes)
        for fine, size in zip(told, (1e-8, 1e-14)):
            self.assertAlmostEqual(math.log10(fine["tets"] * size**3), 1, delta=0.5)
        self.assertIsNone(told[2]["tets"])  # more than a double can represent
        text = self.expect(0, "info", self.box, "--predict", sizes).stdout
        rows = re.findall(r"^ +([\de.-]+) +(\S+) +\S+$", text, re.M)
        for (_, tets), p in zip(rows, told[:2]):
            self.assertAlmostEqual(float(tets) / p["tets"], 1, delta=0.01)
        self.assertEqual(rows[2], ("1e-120", "inf"))

    def test_what_cannot_be_predicted(self):
        self.expect(2, "info", self.box, "--predict=-1", says=["--predict", "-1", "a length"])
        self.expect(2, "info", self.box, "--predict", "1,much", says=["--predict", "much", "a length"])
        self.expect(2, "info", self.box, "--predict", "nan", says=["--predict", "nan"])
        self.expect(2, "info", self.box, "--size", "1", says=["--size", "--predict"])
        smaller = ("--predict", "0.1", "--size-min", "0.2")
        self.expect(2, "info", self.box, *smaller, says=["size-min 0.2", "0.1"])
        of_size = ("--size", "0.1", "--size-min", "0.2", "--predict", "0")
        self.expect(2, "info", self.box, *of_size, says=["size-min 0.2", "0.1"])
        self.expect(0, "info", self.box, "--size-min", "0.2", "--predict", "0")
        of_unknown = ("--predict", "1", "--patch-size", "99=1")
        self.expect(2, "info", self.box, *of_unknown, says=["99", "the tags are 1, 2"])
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", writes=True)
        told = self.expect(2, "info", self.out, "--predict", "1", writes=True).stderr
        self.assertRegex(told, "--predict.*is a mesh already")


if __name__ == "__main__":
    unittest.main()
