"""Help, version, and messages about wrong calls.
Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import os
import pty
import subprocess
import unittest

from program import MODELS, PROGRAM, ProgramTest


class Usage(ProgramTest):
    def test_help_tells_defaults_and_codes(self):
        run = self.expect(0, "--help")
        for text in ("1/20 of the diagonal", "less where the part is thin", "--coarsen", "--collar-angle", "--theta",
                     "--improve", "Exit codes", "check", "info"):
            self.assertIn(text, run.stdout)
        for command in ("check", "info", "convert", "repair"):
            self.assertIn("--feature-angle", self.expect(0, command, "--help").stdout)

    def test_version(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"collarmesh \d+\.\d+\.\d+")

    def test_mistakes(self):
        for arguments in ((), (self.box,), ("-o", self.out), (self.box, "-o", self.out, "--sise", "1"),
                          (self.box, "-o", self.out, "--size", "nan"), (self.box, "-o", self.out, "--size", "-1"),
                          (self.box, "-o", self.out, "--size", "small"),
                          (self.box, "-o", self.out, "--radius-edge", "0.5"),
                          (self.box, "-o", self.out, "--region-size", "1"),
                          (self.box, "-o", self.out, "--theta", "0.7"), (self.box, "-o", self.out, "-v", "-q"),
                          (self.box, "-o", self.out, "--progress", "loud"),
                          (self.box, "-o", self.out, "--max-memory", "much"), ("check", self.out), ("info",),
                          (self.box, "-o", self.out, "--max-vertices", "-5")):
            with self.subTest(arguments=arguments):
                self.assertNotEqual(self.expect(2, *arguments).stderr, "")

    def test_mistakes_are_told_in_words(self):
        for arguments, says in (
                ("--progress loud", "--progress: 'loud' is not one of auto, json, none"),
                ("--max-memory 5X", "--max-memory: '5X' is not a size such as 500M, 1.5G"),
                ("--size", "--size: its LENGTH is missing; write --size LENGTH"),
                ("--sise 1", "--sise: there is no such option; did you mean --size"),
                ("--wrong 1", "--wrong: there is no such option or argument; see --help"),
                ("--size 1 --size 2", "--size: is given more than once; give it once"),
                ("--quiet=maybe", "--quiet: takes no value; write --quiet alone"),
                ("--improve 1.5", "--improve: '1.5' is not one of 0, 1, 2, 3"),
                ("--time-limit 5s", "--time-limit: '5s' is not a number of seconds"),
                ("--planar-tolerance 0.1", "--planar-tolerance: '0.1' is not a number from 0 to 0.01")):
            with self.subTest(arguments=arguments):
                run = self.expect(2, self.box, "-o", self.out, *arguments.split())
                self.assertTrue(run.stderr.startswith(f"collarmesh: {says}"), run.stderr)
        for arguments, says in (
                ((), "INPUT, a file to mesh, is required; write collarmesh INPUT... -o OUT"),
                (("check", self.out), "--against is required; write collarmesh check MESH --against INPUT..."),
                (("info", "--jsn", self.box), "--jsn: there is no such option; did you mean --json"),
                ((self.box, "info"), "a subcommand comes first")):
            with self.subTest(arguments=arguments):
                self.assertTrue(self.expect(2, *arguments).stderr.startswith(f"collarmesh: {says}"))

    def test_contradictions(self):
        self.expect(2, self.box, "-o", self.out, "--size", "0.1", "--size-min", "0.2", says=["size-min"])
        self.expect(2, self.box, "-o", self.out, "--vertex-ratio", "2", says=["vertex-ratio"])
        self.expect(2, self.box, "-o", self.out, "--report", self.out, says=["report"])
        twice = ("--report", "report.json", "--report", "report.json")
        self.expect(2, self.box, "-o", self.out, *twice, says=["report.json twice"])
        over = ("--report", "report.json", "--report", self.box)
        self.expect(2, self.box, "-o", self.out, *over, says=["would overwrite"])

    def test_unknown_output_format_is_told_before_reading(self):
        self.expect(2, "no_such_file.off", "-o", "mesh.xyz", says=["xyz", r"\.vtu"])

    def test_unknown_tag_is_told_with_the_known_ones(self):
        self.expect(2, MODELS / "two_boxes.poly", "-o", self.out, "--region-size", "9=0.1", says=["9", "1, 2"])

    def test_sizes_are_repeatable_and_leave_the_inputs_alone(self):
        self.expect(0, "--size", "0.5", "--region-size", "1=0.4", "--region-size", "2=0.3", MODELS / "two_boxes.poly",
                    "-o", self.out, "--max-memory", "1.5g", writes=True)


class Progress(ProgramTest):
    def test_json_lines(self):
        run = self.run_program(self.box, "-o", self.out, "--size", "0.05", "--progress", "json", "-q")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "", "-q silences progress too")
        run = self.run_program(self.box, "-o", self.out, "--size", "0.04", "--progress", "json")
        lines = [json.loads(line) for line in run.stderr.splitlines() if line.startswith("{")]
        self.assertTrue(all(set(line) == {"phase", "fraction", "vertices", "tets", "seconds"} for line in lines))
        fractions = [line["fraction"] for line in lines]
        self.assertEqual(fractions, sorted(fractions))
        self.assertTrue(0 <= fractions[0] and fractions[-1] <= 1)
        phases = [line["phase"] for line in lines]
        self.assertEqual([p for p in ("read", "complex", "refine", "check", "write") if p not in phases], [])

    def test_nothing_but_the_summary_without_a_terminal(self):
        run = self.run_program(self.box, "-o", self.out, "--size", "0.05")
        self.assertNotIn("\r", run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertIn("every guarantee holds", run.stderr)

    def test_help_of_everything_fits_a_terminal(self):
        help_all = self.run_program("--help-all")
        self.assertEqual(help_all.returncode, 0, help_all.stderr)
        for option in ("--size-field", "--against", "--predict", "--input-format", "--json"):
            self.assertIn(option, help_all.stdout)
        for arguments in (["--help-all"], ["--help"], *([c, "--help"] for c in ("check", "info", "convert", "repair"))):
            for line in self.run_program(*arguments).stdout.splitlines():
                self.assertLessEqual(len(line), 80, line)

    def complete(self, *words):
        """Returns bash's proposals for the last word."""
        script = self.run_program("--generate", "bash").stdout
        line = f"COMP_WORDS=({' '.join(words)} ''); COMP_CWORD={len(words)}; _collarmesh; echo ${{COMPREPLY[@]}}"
        run = subprocess.run(["bash", "-c", script + line], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return set(run.stdout.split())

    def test_values_are_completed(self):
        self.assertEqual(self.complete("collarmesh", "a.off", "--order"), {"1", "2"})
        self.assertEqual(self.complete("collarmesh", "a.off", "--improve"), {"0", "1", "2", "3"})
        self.assertEqual(self.complete("collarmesh", "a.off", "--coarsen"), {"on", "off"})
        self.assertLessEqual({"vtu", "msh2", "bdf", "polymesh"}, self.complete(
            "collarmesh", "convert", "a.off", "--format"))
        self.assertLessEqual({"vtu", "stl"}, self.complete("collarmesh", "convert", "-", "--input-format"))

    def test_quiet_and_verbose(self):
        quiet = self.run_program(self.box, "-o", self.out, "--size", "0.3", "-q")
        self.assertEqual((quiet.returncode, quiet.stderr, quiet.stdout), (0, "", ""))
        verbose = self.run_program(self.box, "-o", self.out, "--size", "0.3", "-v")
        self.assertIn("vertices inserted", verbose.stderr)

    def test_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        process = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size",
                                   "0.025"], cwd=self.folder, stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                block = os.read(ours, 4096)
            except OSError:
                break
            if not block:
                break
            shown += block
        os.close(ours)
        self.assertEqual(process.wait(timeout=60), 0)
        self.assertRegex(shown.decode(), r"\[#*\.*\] +\d+%  refine")
        self.assertRegex(shown.decode(), r"\d+ s left")


class Reproducibility(ProgramTest):
    def test_same_bytes(self):
        for model in ("bracket.off", "two_boxes.poly"):
            meshes = []
            for k, seed in enumerate((0, 0, 1)):
                mesh = self.folder / f"{k}.vtu"
                self.assertEqual(self.run_program(MODELS / model, "-o", mesh, "--seed", seed).returncode, 0)
                meshes.append(mesh.read_bytes())
            self.assertEqual(meshes[0], meshes[1])
            self.assertNotEqual(meshes[0], meshes[2])


if __name__ == "__main__":
    unittest.main()
