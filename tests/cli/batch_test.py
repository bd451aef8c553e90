"""Several parts in one call.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import os
import signal
import subprocess
import unittest

from program import BOX_FACES, MODELS, PROGRAM, ProgramTest, box_points, off_text


class Batch(ProgramTest):
    def table(self, run):
        """Returns the rows of the table by the name of the part."""
        rows = [line.split(maxsplit=5) for line in run.stdout.splitlines()]
        self.assertEqual(rows[0], ["part", "tets", "smallest", "largest", "seconds", "result"])
        return {row[0]: row[1:] for row in rows[1:-1]}

    def test_all_good(self):
        run = self.run_program(MODELS / "box.off", MODELS / "sphere.off", "--batch", "made/here", "--report", "json",
                               "--report", "html", "--format", "vtk")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual({path.name for path in (self.folder / "made/here").iterdir()},
                         {f"{part}.{kind}" for part in ("box", "sphere") for kind in ("vtk", "json", "html")})
        table = self.table(run)
        for part in ("box", "sphere"):
            report = json.loads((self.folder / f"made/here/{part}.json").read_text())
            row = table[str(MODELS / f"{part}.off")]
            self.assertEqual((row[0], row[4]), (str(report["mesh"]["tets"]), "every guarantee holds"))
            self.assertAlmostEqual(float(row[1]), report["mesh"]["min_dihedral"], places=2)
        self.assertIn("2 of 2 parts have a mesh", run.stdout)

    def test_each_is_as_if_meshed_alone(self):
        self.run_program(MODELS / "box.off", MODELS / "sphere.off", "--batch", "made", "--size", "0.3")
        for part in ("box", "sphere"):
            self.run_program(MODELS / f"{part}.off", "-o", self.out, "--size", "0.3")
            self.assertEqual((self.folder / f"made/{part}.vtu").read_bytes(), self.out.read_bytes())

    def test_goes_on_after_a_failure(self):
        open_box = self.write("open.off", off_text(box_points(), BOX_FACES[:3]))
        (self.folder / "bad.off").write_text("OFF\nnothing\n")
        run = self.run_program(open_box, "bad.off", self.box, "missing.off", "--batch", "made", "--repair", "none")
        self.assertEqual(run.returncode, 4, run.stderr)
        self.assertEqual({name: row[4] for name, row in self.table(run).items()},
                         {str(open_box): "not a valid complex", "bad.off": "cannot be read",
                          str(self.box): "every guarantee holds", "missing.off": "cannot be read"})
        self.assertEqual([path.name for path in (self.folder / "made").iterdir()], ["box.vtu"])
        self.assertIn("1 of 4 parts have a mesh", run.stdout)

    def test_mistakes(self):
        for code, says, *arguments in (
                (2, "contradicts --output", self.box, "--batch", "made", "-o", self.out),
                (2, "the meshes of .*box.off and .*box.off the same name", self.box, MODELS / "box.off", "--batch",
                 "made"),
                (2, "must be json or html", self.box, "--batch", "made", "--report", "r.json"),
                (2, "would overwrite the input", "made/box.vtu", "--batch", "made"),
                (8, "made", self.box, "--batch", "box.off/made")):
            (self.folder / "made").mkdir(exist_ok=True)
            (self.folder / "made/box.vtu").write_text("")
            run = self.run_program(*arguments)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertRegex(run.stderr, says)

    def test_a_signal_ends_all_of_it(self):
        run = subprocess.Popen([PROGRAM, MODELS / "box.off", MODELS / "sphere.off", "--batch", "made", "--size",
                                "0.004", "--progress", "json"],
                               cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        for line in run.stderr:
            if line.startswith("{") and json.loads(line).get("phase") == "refine":
                break
        os.kill(run.pid, signal.SIGTERM)
        out, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 6, err)
        self.assertEqual(out.count("cancelled"), 2, out)
        self.assertEqual(list((self.folder / "made").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
