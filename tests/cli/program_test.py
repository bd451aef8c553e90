"""The program as its users meet it: exit codes, messages, files, signals.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import math
import os
import pathlib
import pty
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["COLLARMESH_PROGRAM"]
SOURCES = pathlib.Path(__file__).resolve().parents[2]
MODELS = SOURCES / "resources" / "models"
COORDINATES = re.compile(r"\(?-?\d[\d.e+-]*, ?-?\d[\d.e+-]*, ?-?\d[\d.e+-]*\)?")

BOX_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box_points(low=(0, 0, 0), high=(1, 1, 1)):
    return [(x, y, z) for z in (low[2], high[2])
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]


def off_text(points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(str, p)) for p in points]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines) + "\n"


def wedge_text(degrees):
    """A prism whose cross-section has this angle at the edge from (0, 0, 0) to (0, 0, 1)."""
    t = math.radians(degrees)
    corners = [(0, 0), (1, 0), (math.cos(t), math.sin(t))]
    points = [(x, y, z) for z in (0, 1) for x, y in corners]
    return off_text(points, [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)])


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="collarmesh-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.box = self.write("box.off", off_text(box_points(), BOX_FACES))
        self.out = self.folder / "out.vtu"

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def run_program(self, *arguments, timeout=120):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=timeout,
                              capture_output=True, text=True)

    def expect(self, code, *arguments, says=(), writes=False):
        """Run; check the exit code, what the messages say and whether the mesh is there."""
        run = self.run_program(*arguments)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        for text in says:
            self.assertRegex(run.stderr + run.stdout, text)
        self.assertEqual(self.out.exists(), writes)
        self.assert_nothing_left()
        return run

    def assert_nothing_left(self):
        left = [p.name for p in self.folder.iterdir() if p.name.startswith(".") or "tmp" in p.name]
        self.assertEqual(left, [], "temporary files were left")


class Usage(ProgramTest):
    def test_help_tells_defaults_and_codes(self):
        run = self.expect(0, "--help")
        for text in ("1/20 of the diagonal", "1/200 of the diagonal", "--coarsen", "--collar-angle", "--theta", "--improve", "Exit codes", "check", "info"):
            self.assertIn(text, run.stdout)
        for command in ("check", "info", "convert", "repair"):
            self.assertIn("--feature-angle", self.expect(0, command, "--help").stdout)

    def test_version(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"collarmesh \d+\.\d+\.\d+")

    def test_mistakes(self):
        for arguments in ((), (self.box,), ("-o", self.out), (self.box, "-o", self.out, "--sise", "1"),
                          (self.box, "-o", self.out, "--size", "nan"), (self.box, "-o", self.out, "--size", "-1"),
                          (self.box, "-o", self.out, "--size", "small"), (self.box, "-o", self.out, "--radius-edge", "0.5"),
                          (self.box, "-o", self.out, "--region-size", "1"), (self.box, "-o", self.out, "--theta", "0.7"),
                          (self.box, "-o", self.out, "-v", "-q"), (self.box, "-o", self.out, "--progress", "loud"),
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


class Unreadable(ProgramTest):
    def test_typo_proposes_the_similar_name(self):
        self.expect(3, "bax.off", "-o", self.out, says=[r"bax\.off", r"did you mean box\.off"])

    def test_missing(self):
        self.expect(3, "nothing_like_it.stl", "-o", self.out, says=["no such file"])
        self.expect(3, self.folder / "no" / "box.off", "-o", self.out, says=["no such file"])
        self.expect(3, "info", "nothing_like_it.stl", says=["no such file"])
        self.expect(3, "check", "nothing_like_it.vtu", "--against", self.box, says=["no such file"])

    def test_folder(self):
        self.expect(3, self.folder, "-o", self.out, says=["folder"])

    def test_unknown_format(self):
        self.expect(3, self.write("part.xyz", "1 2 3"), "-o", self.out, says=[r"\.xyz", r"\.off"])

    def test_truncated(self):
        text = self.box.read_text()
        self.expect(3, self.write("half.off", text[:len(text) // 2]), "-o", self.out, says=[r"half\.off", r"\d"])

    def test_garbage_mesh(self):
        for name in ("bad.vtu", "bad.msh", "bad.mesh"):
            with self.subTest(name=name):
                self.expect(3, "check", self.write(name, "not a mesh"), "--against", self.box, says=[name])


class Hostile(ProgramTest):
    """Headers that claim two thousand million entities: exit code 3 in a gigabyte of address space."""

    FILES = {
        "off": "OFF\n2000000000 2000000000 0\n0 0 0\n",
        "ply": "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 2000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
        "stl": " " * 80 + "\x7f\x7f\x7f\x7f" + "\0" * 50,
        "om": "OMT\x40\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f",
        "obj": "v 0 0 0\nf 1 2000000000 3\n",
        "poly": "2000000000 3 0 0\n1 0 0 0\n",
        "smesh": "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n2000000000 0\n3 1 2 3\n",
        "vtk": "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2000000000 double\n\0\0\0\0",
        "vtu": '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="2000000000" NumberOfCells="2000000000">'
               '<Points><DataArray type="Float64" NumberOfComponents="3">0 0 0</DataArray></Points></Piece></UnstructuredGrid></VTKFile>',
        "msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2000000000\n1 0 0 0\n$EndNodes\n",
        "mesh": "MeshVersionFormatted 2\nDimension 3\nVertices 2000000000\n0 0 0 1\n",
        "inp": "*NODE\n1, 0, 0, 0\n*ELSET, ELSET=X, GENERATE\n1, 2000000000, 1\n",
        "unv": "    -1\n  2467\n         1         0         0         0         0         0         0 200000000\nname\n    -1\n",
        "ele": "2000000000 4 0\n1 1 2 3 4\n",
    }

    def test_claims_of_gigabytes(self):
        limit = 1 << 30
        self.write("a.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n")
        for extension, text in self.FILES.items():
            with self.subTest(extension=extension):
                (self.folder / f"a.{extension}").write_bytes(text.encode("latin-1"))
                run = subprocess.run([PROGRAM, "info", f"a.{extension}"], cwd=self.folder, timeout=60, capture_output=True,
                                     text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
                self.assertEqual(run.returncode, 3, run.stderr)
                self.assertRegex(run.stderr, rf"a\.{extension}: (line|byte) \d+: ")


class InvalidComplex(ProgramTest):
    def test_open_surface(self):
        model = self.write("open.off", off_text(box_points(), BOX_FACES[1:]))
        self.expect(4, model, "-o", self.out, "--repair", "none", says=[COORDINATES, "Without --repair none"])

    def test_intersection(self):
        other = self.write("other.off", off_text(box_points((0.5, 0.5, 0.5), (2, 2, 2)), BOX_FACES))
        self.expect(4, self.box, other, "-o", self.out, "--repair", "none", says=[COORDINATES])

    def test_what_cannot_be_repaired_says_what_may_help(self):
        sheet = self.write("sheet.off", off_text(box_points()[:4], BOX_FACES[:1]))
        for command in ((sheet, "-o", self.out), ("repair", sheet, "-o", "out.off")):
            self.expect(4, *command, says=["open and encloses nothing", COORDINATES, "close the surface",
                                           "--repair-tolerance", "--repair wrap"])
        self.assertFalse((self.folder / "out.off").exists())
        run = self.expect(0, "info", sheet)
        self.assertIn("0 regions", run.stdout)

    def test_empty(self):
        self.assertIn(self.run_program(self.write("none.off", "OFF\n0 0 0\n"), "-o", self.out).returncode, (3, 4))


class Repair(ProgramTest):
    """Input that is no valid complex, by all commands."""

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
        self.assertRegex(run.stderr, r"\Arepaired: a hole [^\n]*\n\Z")
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


class Budgets(ProgramTest):
    def test_vertices(self):
        self.expect(5, self.box, "-o", self.out, "--size", "0.02", "--max-vertices", "200",
                    says=["the budget of 200 vertices is spent at \\d+ vertices", r"cells, .* MB, after", COORDINATES, "raise max-vertices"])

    def test_memory(self):
        self.expect(5, self.box, "-o", self.out, "--size", "0.01", "--max-memory", "200K",
                    says=["the memory budget of 204800 bytes is spent", COORDINATES, "raise max-memory"])

    def test_memory_has_a_default(self):
        report = self.folder / "report.json"
        self.expect(0, self.box, "-o", self.out, "--report", report, writes=True)
        memory = json.loads(report.read_text())["options"]["max_memory"]
        machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        self.assertGreater(memory, 0)
        self.assertLessEqual(memory, machine // 2)
        self.expect(0, self.box, "-o", self.out, "--max-memory", "0", "--report", report, writes=True)
        self.assertIsNone(json.loads(report.read_text())["options"]["max_memory"])

    def test_options_without_an_end(self):
        """They end at a budget, after a warning."""
        sphere, bracket = MODELS / "sphere.off", MODELS / "bracket.off"
        for option, value in (("--radius-edge", "1"), ("--distance", "1e-9")):
            with self.subTest(option=option):
                self.expect(5, sphere, "-o", self.out, option, value, "--max-memory", "20M",
                            says=[f"warning: {option} ", COORDINATES, "raise max-memory"])
        self.expect(0, bracket, "-o", self.out, "--planar-tolerance", "0.01", says=["warning: --planar-tolerance"],
                    writes=True)

    def test_time(self):
        begin = time.monotonic()
        self.expect(5, self.box, "-o", self.out, "--size", "0.002", "--time-limit", "0.5",
                    says=["time limit of 0.5 s .*stage: refine, .* vertices", COORDINATES, "raise --time-limit"])
        self.assertLess(time.monotonic() - begin, 10)

    def test_time_limits_every_stage(self):
        endless = self.folder / "endless.off"
        os.mkfifo(endless)  # reading it never ends
        self.expect(5, endless, "-o", self.out, "--time-limit", "0.1", says=["time limit of 0.1 s .*stage: read"])
        self.expect(5, self.box, "-o", self.out, "--time-limit", "1e-6", says=["stage: start"])
        begin = time.monotonic()
        self.expect(0, self.box, "-o", self.out, "--size", "0.04", writes=True)
        whole = time.monotonic() - begin
        self.out.unlink()
        codes = set()
        for share in (0.1, 0.2, 0.3, 0.5, 0.7):
            run = self.run_program(self.box, "-o", self.out, "--size", "0.04", "--time-limit", share * whole)
            codes.add(run.returncode)
            self.assertIn(run.returncode, (0, 5), run.stderr)  # 0: it was faster this time
            self.assertEqual(self.out.exists(), run.returncode == 0)
            if run.returncode == 5:
                self.assertRegex(run.stderr, "time limit of .*stage: ")
            self.out.unlink(missing_ok=True)
            self.assert_nothing_left()
        self.assertIn(5, codes)


class Cancelling(ProgramTest):
    def start_long_run(self):
        process = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.002", "--progress", "json"],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        for line in process.stderr:
            if json.loads(line)["phase"] == "refine":
                break
        time.sleep(0.3)
        return process

    def test_interrupt_stops_within_a_second(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                process = self.start_long_run()
                begin = time.monotonic()
                process.send_signal(number)
                _, messages = process.communicate(timeout=20)
                self.assertLess(time.monotonic() - begin, 2)  # a second, on a busy machine
                self.assertEqual(process.returncode, 6, messages)
                self.assertIn("cancelled", messages)
                self.assertFalse(self.out.exists())
                self.assert_nothing_left()

    def test_interrupt_ends_every_stage(self):
        """As the time limit does: both set the same flag. A stage that does not see it goes on to the next one."""
        command = [PROGRAM, str(self.box), "-o", str(self.out), "--size", "0.03", "--order", "2", "--progress", "json"]

        def stages(stop_at=None):
            process = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            begun = []
            for line in process.stderr:
                phase = json.loads(line).get("phase") if line.startswith("{") else None
                if phase and phase not in begun:
                    begun.append(phase)
                    if phase == stop_at:
                        process.send_signal(signal.SIGTERM)
            code = process.wait(timeout=120)
            process.stderr.close()
            return code, begun

        code, every = stages()
        self.assertEqual(code, 0)
        self.out.unlink()
        for stage in ("refine", "coarsen", "improve", "check"):  # each takes a while
            with self.subTest(stage=stage):
                code, begun = stages(stage)
                self.assertEqual((code, begun[-1]), (6, stage))
                self.assertFalse(self.out.exists())
                self.assert_nothing_left()
        for stage in set(every) - {"refine", "coarsen", "improve", "check"}:
            with self.subTest(stage=stage):
                code, _ = stages(stage)
                self.assertIn(code, (0, 6))  # it may be too late
                self.assertEqual(self.out.exists(), code == 0)
                self.out.unlink(missing_ok=True)
                self.assert_nothing_left()

    def test_interrupt_at_any_time_leaves_no_half_file(self):
        arguments = [PROGRAM, str(self.box), "-o", str(self.out), "--size", "0.05", "-q"]
        begin = time.monotonic()
        self.assertEqual(subprocess.run(arguments, cwd=self.folder).returncode, 0)
        duration, complete = time.monotonic() - begin, self.out.stat().st_size
        for k in range(10):
            self.out.unlink(missing_ok=True)
            process = subprocess.Popen(arguments, cwd=self.folder, stderr=subprocess.DEVNULL)
            time.sleep(0.02 + duration * k / 9)
            process.send_signal(signal.SIGINT)
            code = process.wait(timeout=20)
            self.assertIn(code, (0, 6, -signal.SIGINT))
            self.assertEqual(self.out.exists(), code == 0)
            if code == 0:
                self.assertEqual(self.out.stat().st_size, complete)
            self.assert_nothing_left()


class MeshesOfOtherPrograms(ProgramTest):
    """They pass, or fail for their elements, not for their labels."""

    def other_program(self, *command):
        if shutil.which(command[0]) is None:
            self.skipTest(f"{command[0]} is not installed")
        run = subprocess.run(list(map(str, command)), cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def check_judgement(self, mesh, surface):
        lenient = self.run_program("check", mesh, "--against", surface, "--radius-edge", "1000", "--json")
        report = json.loads(lenient.stdout)
        self.assertTrue(report["passed"], lenient.stdout)
        self.assertAlmostEqual(report["region_volumes"]["1"], 1, places=9)
        self.assertGreater(report["edges"], 0)
        bound = report["max_radius_edge"]
        strict = self.run_program("check", mesh, "--against", surface, "--radius-edge", str(0.95 * bound),
                                  "--thin-angle", "0", "--json")
        self.assertEqual(strict.returncode, 7)
        self.assertEqual({f["guarantee"] for f in json.loads(strict.stdout)["findings"]}, {"radius_edge"})

    def test_gmsh_from_stl(self):
        self.expect(0, "convert", self.box, "-o", "box.stl")
        self.write("box.geo", 'Merge "box.stl";\nSurface Loop(1) = {1};\nVolume(1) = {1};\nMesh.MeshSizeMax = 0.4;\n')
        for extension, format_name in (("msh", "msh41"), ("msh", "msh22"), ("mesh", "mesh"), ("unv", "unv"), ("vtk", "vtk"), ("inp", "inp")):
            with self.subTest(format=format_name):
                mesh = self.folder / f"{format_name}.{extension}"
                self.other_program("gmsh", "-3", "-v", "0", "-format", format_name, "-o", mesh, "box.geo")
                self.check_judgement(mesh, self.box)

    def test_gmsh_from_geo(self):
        self.write("box.geo", 'SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\nMesh.MeshSizeMax = 0.3;\n'
                   "Physical Volume(77) = {1};\nPhysical Surface(88) = {1:6};\n")
        for extension, format_name in (("msh", "msh41"), ("msh", "msh22"), ("mesh", "mesh"), ("inp", "inp")):
            with self.subTest(format=format_name):
                mesh = self.folder / f"{format_name}.{extension}"
                self.other_program("gmsh", "-3", "-v", "0", "-format", format_name, "-o", mesh, "box.geo")
                self.check_judgement(mesh, self.box)

    def test_tetgen(self):
        self.expect(0, "convert", self.box, "-o", "box.poly")
        self.other_program("tetgen", "-pq1.4a0.01Q", "box.poly")
        self.check_judgement(self.folder / "box.1.ele", self.box)


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

    def test_a_mesh_that_misses_a_guarantee_is_written(self):
        """A segment that leaves a corner at a small angle, without a collar: edges there become ever shorter."""
        points = box_points() + [(0.5, 0.05, 0.05)]
        lines = [f"{len(points)} 3 0 0", *(f"{k} {p[0]} {p[1]} {p[2]}" for k, p in enumerate(points)),
                 f"{len(BOX_FACES) + 1} 0"]
        lines += [f"1\n{len(f)} " + " ".join(map(str, f)) for f in (*BOX_FACES, (0, 8))]
        model = self.write("segment.poly", "\n".join([*lines, "0", "0"]) + "\n")
        report = self.folder / "report.json"
        run = self.expect(7, model, "-o", self.out, "--crease-angle", "0", "--report", report, writes=True)
        self.assertRegex(run.stderr, "collarmesh: a guarantee is missed: .*near " + COORDINATES.pattern + ".*crease-angle")
        found = json.loads(report.read_text())
        self.assertEqual((found["status"], found["guarantees_hold"]), ("guarantee_missed", False))
        self.assertEqual(self.run_program("info", self.out).returncode, 0)
        self.out.unlink()
        self.expect(0, model, "-o", self.out, writes=True)

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

    def test_quiet_and_verbose(self):
        quiet = self.run_program(self.box, "-o", self.out, "--size", "0.3", "-q")
        self.assertEqual((quiet.returncode, quiet.stderr, quiet.stdout), (0, "", ""))
        verbose = self.run_program(self.box, "-o", self.out, "--size", "0.3", "-v")
        self.assertIn("vertices inserted", verbose.stderr)

    def test_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        process = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.025"], cwd=self.folder, stderr=theirs)
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
        self.expect(8, self.box, "-o", self.out, "--report", "/dev/null", says=["no regular file"])

    def test_warnings_of_the_input(self):
        model = self.write("two.poly", (MODELS / "two_boxes.poly").read_text())
        text = model.read_text()
        path = self.folder / "report.json"
        self.expect(0, model, "-o", self.out, "--report", path, writes=True)
        self.assertEqual(json.loads(path.read_text())["complex"]["warnings"], [])
        lines = text.rstrip().splitlines()
        at = max(k for k, line in enumerate(lines) if line.split() == ["2"] or line.split()[:1] == ["2"] and len(line.split()) == 1)
        lines[at] = "3"
        outside = self.write("outside.poly", "\n".join([*lines, "3 70 0 0 5"]) + "\n")
        run = self.expect(0, outside, "-o", self.out, "-q", "--report", path, writes=True)
        self.assertRegex(run.stderr, r"^warning: .*outside\.poly: the region point \(70, 0, 0\) lies outside")
        warnings = json.loads(path.read_text())["complex"]["warnings"]
        self.assertEqual([w["where"] for w in warnings], [[70, 0, 0]])
        self.assertIn("warning: ", self.expect(0, "info", outside, writes=True).stdout)

    def test_a_link_is_followed(self):
        named, link = self.folder / "named.json", self.folder / "link.json"
        named.write_text("old")
        link.symlink_to(named)
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", "--report", link, writes=True)
        self.assertTrue(link.is_symlink())
        self.assertTrue(json.loads(named.read_text())["guarantees_hold"])

    def test_no_report_of_a_failure(self):
        path = self.folder / "report.json"
        self.expect(5, self.box, "-o", self.out, "--size", "0.02", "--max-vertices", "100", "--report", path)
        self.assertFalse(path.exists())

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
        straight, curved = (self.predictions(sphere, "--predict", coarse, "--order", order)[0]["tets"] for order in "12")
        self.assertGreater(curved, straight)  # near enough to the sphere to be curved
        near = self.predictions(sphere, "--predict", coarse, "--distance", coarse / 500)[0]["tets"]
        self.assertGreater(near, curved)

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
        self.assertIsNone(told[2]["tets"])  # more than a double holds
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


class Convert(ProgramTest):
    def convert(self, code, *arguments, says=(), data=None):
        run = subprocess.run([PROGRAM, "convert", *map(str, arguments)], cwd=self.folder, timeout=120,
                             capture_output=True, input=data)
        self.assertEqual(run.returncode, code, run.stderr)
        for text in says:
            self.assertRegex(run.stderr.decode(), text)
        self.assert_nothing_left()
        return run.stdout

    def volume(self, path):
        run = self.run_program("info", path, "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return sum(region["volume"] for region in json.loads(run.stdout)["complex"]["regions"])

    def test_surfaces_both_ways(self):
        formats = ["off", "obj", "stl", "ply", "om", "poly", "smesh"]
        for first in formats:
            self.convert(0, self.box, "-o", f"a.{first}")
            for second in formats:
                with self.subTest(first=first, second=second):
                    self.convert(0, f"a.{first}", "-o", f"b.{second}")
                    self.assertAlmostEqual(self.volume(f"b.{second}"), 1)

    def test_cavities_and_regions_get_points(self):
        inner = [(0.25 + p[0] / 2, 0.25 + p[1] / 2, 0.25 + p[2] / 2) for p in box_points()]
        hollow = off_text(box_points() + inner, BOX_FACES + [tuple(8 + v for v in reversed(f)) for f in BOX_FACES])
        self.write("hollow.off", hollow)
        for name in ("hollow.poly", "hollow.smesh"):
            self.convert(0, "hollow.off", "-o", name, says=["1 region points, 1 hole points"])
            self.assertAlmostEqual(self.volume(name), 0.875)

    def test_several_files_become_one_complex(self):
        self.write("upper.off", off_text(box_points((0, 0, 1), (1, 1, 3)), BOX_FACES))
        self.convert(0, self.box, "upper.off", "-o", "both.poly",
                     says=["welded: 4 points", "dropped: 1 facets that repeat", "2 region points"])
        self.assertAlmostEqual(self.volume("both.poly"), 3)
        self.convert(0, self.box, "upper.off", "-o", "both.vtu", "--size", "0.5",
                     says=["merged: 2 triangles", "every guarantee holds"])
        self.assertEqual(self.run_program("check", "both.vtu", "--against", "both.poly").returncode, 0)

    def test_says_what_is_welded_and_dropped(self):
        points = box_points() + [(0, 0, 0), (9, 9, 9)]
        faces = [(8, 3, 2, 1), *BOX_FACES[1:], BOX_FACES[1], (0, 8, 1)]
        self.write("dirty.off", off_text(points, faces))
        self.convert(0, "dirty.off", "-o", "clean.off",
                     says=["clean.off: 8 points, 6 facets", "welded: 1 points",
                           "1 points that nothing uses", "1 facets without three", "1 facets that repeat"])
        self.assertAlmostEqual(self.volume("clean.off"), 1)
        self.convert(0, MODELS / "two_boxes.poly", "-o", "a.stl",
                     says=["cut into triangles: 11 facets", "no place for: 22 tags of facets, 2 region points"])

    def test_meshes_of_every_format(self):
        self.convert(0, MODELS / "two_boxes.poly", "-o", "a.vtu", "--size", "0.5")
        for extension in ("vtk", "msh", "mesh", "unv", "ele", "vtu", "inp"):
            with self.subTest(extension=extension):
                self.convert(0, "a.vtu", "-o", f"b.{extension}", says=[rf"b\.{extension}: \d+ tets of order 1"])
                check = self.run_program("check", f"b.{extension}", "--against", MODELS / "two_boxes.poly")
                self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
        self.convert(0, "a.vtu", "-o", "b.inp", says=["no place for: .*edges on curves"])
        self.assertEqual(self.run_program("info", "b.inp").returncode, 0)
        self.convert(0, "b.inp", "-o", "skin.poly", says=["2 region points"])
        self.assertAlmostEqual(self.volume("skin.poly"), self.volume(MODELS / "two_boxes.poly"))

    def test_collars_in_every_format(self):
        wedge = self.write("wedge.off", wedge_text(20))
        self.convert(0, wedge, "-o", "a.vtu", "--size", "0.3", "--coarsen", "off")
        for extension in ("vtk", "msh", "mesh", "unv", "ele", "vtu", "inp"):
            with self.subTest(extension=extension):
                self.convert(0, "a.vtu", "-o", f"b.{extension}")
                check = self.run_program("check", f"b.{extension}", "--against", wedge, "--json")
                report = json.loads(check.stdout)
                self.assertTrue(report["passed"], check.stdout)
                self.assertGreater(report["collar_tets"], 0)
                blunt = self.run_program("check", f"b.{extension}", "--against", wedge, "--crease-angle", "5", "--json")
                self.assertEqual(json.loads(blunt.stdout)["collar_tets"], 0)

    def test_thin_tets_in_every_format(self):
        wedge = self.write("wedge.off", wedge_text(20))
        self.convert(0, wedge, "-o", "a.vtu", "--size", "0.3")
        for extension in ("vtk", "msh", "mesh", "unv", "ele", "vtu", "inp"):
            with self.subTest(extension=extension):
                self.convert(0, "a.vtu", "-o", f"b.{extension}")
                check = self.run_program("check", f"b.{extension}", "--against", wedge, "--json")
                report = json.loads(check.stdout)
                self.assertTrue(report["passed"], check.stdout)
                # Where no cell is marked all at the crease count as its collar's.
                self.assertGreater(report["thin_tets"] + report["collar_tets"], 0)
                if extension in ("vtk", "msh", "vtu"):
                    self.assertGreater(report["thin_tets"], 0)

    def test_says_which_triangles_are_lost(self):
        self.write("loose.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n"
                   "2 2 2 1\nTetrahedra 1\n1 2 3 4 1\nTriangles 2\n1 2 3 1\n1 2 5 1\nEnd\n")
        self.convert(0, "loose.mesh", "-o", "a.inp", says=["no place for: 1 triangles that are no side of a tet"])

    def test_standard_input_and_output(self):
        off = self.convert(0, self.box, "-o", "-", "--format", "off")
        self.assertTrue(off.startswith(b"OFF"))
        stl = self.convert(0, "-", "--input-format", "off", "-o", "-", "--format", "STL", data=off)
        self.assertEqual(len(stl), 84 + 12 * 50)
        msh = self.convert(0, "-", "--input-format", "stl", "-o", "-", "--format", "msh", "--size", "0.5", data=stl,
                           says=["standard output: ", "every guarantee holds"])
        self.assertTrue(msh.startswith(b"$MeshFormat"))
        self.convert(3, "-", "--input-format", "off", "-o", "out.stl", data=b"OFF 3", says=["/dev/stdin: line 1"])

    def test_mistakes(self):
        self.convert(2, self.box, "-o", "out.xyz", says=["xyz", r"\.stl", r"\.vtu"])
        self.convert(2, self.box, "-o", "-", says=["--format"])
        self.convert(2, "-", "-o", "a.off", says=["--input-format"])
        self.convert(2, self.box, "-o", "-", "--format", "ele", says=["several files"])
        self.convert(2, self.box, "-o", "a.dat", "--format", "dat", says=["'.dat' is not known"])
        self.convert(3, "missing.off", "-o", "a.stl", says=["no such file"])
        self.convert(8, self.box, "-o", "missing/a.stl", says=["does not exist"])


MODULES = pathlib.Path(PROGRAM).parents[1] / "lib" / "collarmesh"
HAS_SCOTCH = (MODULES / "collarmesh_scotch.so").exists()
HAS_HDF5 = (MODULES / "collarmesh_hdf5.so").exists()


class Partitions(ProgramTest):
    """--partitions and --ghost-cells, in meshing and converting."""

    formats = ["vtu", "pvtu", "vtk", "msh", "msh2"] + (["xdmf", "med"] if HAS_HDF5 else [])

    def setUp(self):
        super().setUp()
        if not HAS_SCOTCH:
            self.expect(2, self.box, "-o", self.out, "--partitions", "2", says=["libscotch-dev"])
            self.skipTest("built without Scotch")

    def partitions(self, path):
        run = self.run_program("info", path, "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)["mesh"]["partitions"]

    def divide(self, output, partitions, *options):
        return self.run_program(
            self.box, "-o", output, "--size", "0.3", "--partitions", partitions, *options)

    def test_a_mesh_is_divided_evenly(self):
        for model, partitions in (("bracket.off", 4), ("two_boxes.poly", 7)):
            with self.subTest(model=model):
                self.out.unlink(missing_ok=True)
                report = self.folder / "report.json"
                options = ("-o", self.out, "--partitions", partitions, "--report", report)
                run = self.expect(0, MODELS / model, *options, writes=True)
                self.assertRegex(run.stderr + run.stdout,
                                 rf"{partitions} partitions: \d+ to \d+ tets .*, \d+ faces cut")
                found = self.partitions(self.out)
                self.assertEqual(found["count"], partitions)
                self.assertLessEqual(found["imbalance"], 0.03)
                self.assertGreater(found["cut_faces"], 0)
                told = json.loads(report.read_text())
                self.assertEqual(told["mesh"]["partitions"], found)
                self.assertEqual(told["options"]["partitions"], partitions)
                checked = self.run_program("check", self.out, "--against", MODELS / model)
                self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_the_mesh_itself_is_the_same(self):
        meshes = []
        for extra in ((), ("--partitions", "3")):
            self.expect(0, MODELS / "two_boxes.poly", "-o", self.out, *extra, writes=True)
            self.assertEqual(self.run_program("convert", self.out, "-o", "a.mesh").returncode, 0)
            meshes.append((self.folder / "a.mesh").read_bytes())
            self.out.unlink()
        self.assertEqual(*meshes)

    def test_threads_change_nothing(self):
        files = []
        for threads in (1, 2, 8):
            self.out.unlink(missing_ok=True)
            options = ("--size", "0.1", "--partitions", "5", "--threads", threads)
            self.expect(0, self.box, "-o", self.out, *options, writes=True)
            files.append(self.out.read_bytes())
        self.assertEqual(len(set(files)), 1)

    def test_every_format_that_holds_them(self):
        for order in (1, 2):
            options = ("--size", "0.2", "--partitions", "6", "--order", order)
            self.assertEqual(self.run_program(self.box, "-o", "a.vtu", *options).returncode, 0)
            first = self.partitions("a.vtu")
            for extension in self.formats:
                with self.subTest(order=order, extension=extension):
                    run = self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
                    self.assertEqual(run.returncode, 0, run.stderr)
                    self.assertNotRegex(run.stderr, "no place for: .*partitions")
                    self.assertEqual(self.partitions(f"b.{extension}"), first)
                    checked = self.run_program("check", f"b.{extension}", "--against", self.box)
                    self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
                    divided = self.run_program(self.box, "-o", f"c.{extension}", *options)
                    self.assertEqual(divided.returncode, 0, divided.stderr)
                    self.assertEqual(self.partitions(f"c.{extension}"), first)
        for extension in ("mesh", "inp", "unv", "ele"):
            with self.subTest(extension=extension):
                run = self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertRegex(run.stderr, "no place for: .*6 partitions")
                self.assertIsNone(self.partitions(f"b.{extension}"))
                for arguments in ((self.box, "-o"), ("convert", "a.vtu", "-o")):
                    run = self.run_program(*arguments, f"d.{extension}", "--partitions", "2")
                    self.assertEqual(run.returncode, 2)
                    self.assertRegex(
                        run.stderr, rf"--partitions: \.{extension} has no place for partitions; use .*\.msh")
                    self.assertFalse((self.folder / f"d.{extension}").exists())

    def test_convert_divides_anew(self):
        self.expect(0, self.box, "-o", self.out, "--size", "0.2", "--partitions", "6", writes=True)
        for partitions in (1, 2, 9):
            run = self.run_program("convert", self.out, "-o", "b.msh", "--partitions", partitions)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertRegex(run.stderr, rf" {partitions} partitions?: ")
            self.assertEqual(self.partitions("b.msh")["count"], partitions)

    def test_pieces_appear_together(self):
        run = self.run_program(self.box, "-o", "a.pvtu", "--size", "0.3", "--partitions", "3")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual({p.name for p in self.folder.glob("a*")},
                         {"a.pvtu", "a_0.vtu", "a_1.vtu", "a_2.vtu"})
        self.assertEqual(self.partitions("a.pvtu")["count"], 3)
        before = {p: p.read_bytes() for p in self.folder.glob("a*")}
        (self.folder / "a_1.vtu").unlink()
        (self.folder / "a_1.vtu").mkdir()
        run = self.run_program(self.box, "-o", "a.pvtu", "--size", "0.2", "--partitions", "3")
        self.assertEqual(run.returncode, 8, run.stderr)
        self.assertIn("a_1.vtu", run.stderr)
        for path, data in before.items():
            if path.name != "a_1.vtu":
                self.assertEqual(path.read_bytes(), data)
        self.assert_nothing_left()
        (self.folder / "a_1.vtu").rmdir()
        run = self.run_program("info", "a.pvtu")
        self.assertEqual(run.returncode, 3)
        self.assertIn("a_1.vtu", run.stderr)

    def test_pieces_do_not_replace_the_input(self):
        self.assertEqual(self.run_program(self.box, "-o", "a_0.vtu", "--size", "0.3").returncode, 0)
        before = (self.folder / "a_0.vtu").read_bytes()
        run = self.run_program("convert", "a_0.vtu", "-o", "a.pvtu", "--partitions", "2")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("would overwrite", run.stderr)
        self.assertEqual((self.folder / "a_0.vtu").read_bytes(), before)
        self.assertEqual(self.run_program(self.box, "-o", "b.pvtu", "--size", "0.3", "--partitions", "2").returncode, 0)
        run = self.run_program("convert", "b.pvtu", "-o", "b_1.vtu")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("b_1.vtu, a file of the input b.pvtu", run.stderr)
        for option in ("--cell-decomposition", "--report"):
            run = self.run_program(self.box, "-o", "c.vtu", "--partitions", "2", option, "c.vtu")
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(f"{option}: names a file of --output", run.stderr)

    def test_pieces_that_are_not_there_yet_are_outputs(self):
        for option in ("--cell-decomposition", "--report"):
            run = self.divide("a.pvtu", 2, option, "./a_0.vtu")
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(f"{option}: names a file of --output", run.stderr)
            self.assertEqual(list(self.folder.glob("a*")), [])
        others = ("--report", "a_x.vtu", "--report", "b_0.vtu")
        run = self.divide("a.pvtu", 2, *others)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(self.partitions("a.pvtu")["count"], 2)
        json.loads((self.folder / "a_x.vtu").read_text())

    def test_pieces_with_names_of_other_programs(self):
        self.assertEqual(self.divide("a.pvtu", 2).returncode, 0)
        (self.folder / "a").mkdir()
        for number in (0, 1):
            (self.folder / f"a_{number}.vtu").rename(self.folder / f"a/a_{number}_0.vtu")
        listed = (self.folder / "a.pvtu").read_text()
        self.write("a.pvtu", re.sub(r'"a_(\d)\.vtu"', r'"a/a_\1_0.vtu"', listed))
        before = (self.folder / "a/a_1_0.vtu").read_bytes()
        run = self.run_program("convert", "a.pvtu", "-o", "a/a_1_0.vtu")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("a/a_1_0.vtu, a file of the input a.pvtu", run.stderr)
        self.assertEqual((self.folder / "a/a_1_0.vtu").read_bytes(), before)
        self.assertEqual(self.run_program("convert", "a.pvtu", "-o", "a_1.vtu").returncode, 0)

    def test_pieces_that_do_not_fit_together(self):
        self.assertEqual(self.divide("a.pvtu", 3).returncode, 0)
        shutil.copy(self.folder / "a_0.vtu", self.folder / "a_1.vtu")
        run = self.run_program("info", "a.pvtu")
        self.assertEqual(run.returncode, 3)
        self.assertRegex(run.stderr, r"a_1\.vtu: cell \d+ is in another place")
        listed = (self.folder / "a.pvtu").read_text()
        self.write("a.pvtu", listed.replace("a_1.vtu", "a_0.vtu"))
        run = self.run_program("info", "a.pvtu")
        self.assertEqual(run.returncode, 3)
        self.assertIn("two pieces are a_0.vtu", run.stderr)
        self.write("a.pvtu", listed)
        self.assertEqual(self.run_program(self.box, "-o", "a_1.vtu", "--size", "0.3").returncode, 0)
        run = self.run_program("info", "a.pvtu")
        self.assertEqual(run.returncode, 3)
        self.assertRegex(run.stderr, r"a_1\.vtu: expected an array 'GlobalPointIds'")

    def test_ghost_cells(self):
        self.expect(0, self.box, "-o", self.out, "--size", "0.2", "--partitions", "4", writes=True)
        wanted = self.partitions(self.out)
        for extension in ("msh", "pvtu"):
            with self.subTest(extension=extension):
                run = self.run_program("convert", self.out, "-o", f"a.{extension}", "--ghost-cells")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(self.partitions(f"a.{extension}"), wanted)
                options = ("--size", "0.2", "--partitions", "4", "--ghost-cells")
                run = self.run_program(self.box, "-o", f"b.{extension}", *options)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(self.partitions(f"b.{extension}"), wanted)
        self.assertIn("$GhostElements", (self.folder / "a.msh").read_text())

    def test_mistakes(self):
        for value in ("0", "-1", "1.5", "many", "1e3", "1000001", "99999999999999999999"):
            self.expect(2, self.box, "-o", self.out, "--partitions", value,
                        says=[r"--partitions: '.*' is not a "
                              r"(number of partitions from 1 to 1000000|whole number)"])
        self.expect(2, self.box, "-o", self.out, "--size", "0.5", "--partitions", "900000",
                    says=[r"partitions is 900000, but the mesh has \d+ tets; ask for 1 to \d+"])
        self.expect(2, self.box, "-o", self.out, "--ghost-cells",
                    says=[r"--ghost-cells: \.vtu has no place.*\.pvtu \.msh"])
        self.expect(2, self.box, "-o", "a.msh", "--ghost-cells", says=["say how many with --partitions"])
        self.expect(2, self.box, "-o", self.out, "--cell-decomposition", "list", says=["say how many with --partitions"])
        self.expect(8, self.box, "-o", self.out, "--partitions", "2", "--cell-decomposition", "missing/list",
                    says=["missing does not exist"])
        to_standard_output = ("-o", "-", "--format", "pvtu", "--partitions", "2")
        self.assertEqual(self.run_program("convert", self.box, *to_standard_output).returncode, 2)
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", writes=True)
        run = self.run_program("convert", self.out, "-o", "a.msh", "--ghost-cells")
        self.assertEqual(run.returncode, 2)
        self.assertIn("is not partitioned", run.stderr)
        run = self.run_program("convert", self.out, "-o", "a.off", "--partitions", "2")
        self.assertEqual(run.returncode, 2)
        self.assertIn(".off has no place for partitions", run.stderr)


if __name__ == "__main__":
    unittest.main()
