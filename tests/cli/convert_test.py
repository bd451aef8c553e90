"""Meshes from format to format, and partitions.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import pathlib
import re
import shutil
import subprocess
import unittest

from program import BOX_FACES, MODELS, PROGRAM, ProgramTest, box_points, off_text, wedge_text

MODULES = pathlib.Path(PROGRAM).parents[1] / "lib" / "collarmesh"
HAS_SCOTCH = (MODULES / "collarmesh_scotch.so").exists()
HAS_HDF5 = (MODULES / "collarmesh_hdf5.so").exists()


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

    @unittest.skipIf(HAS_HDF5, "built with HDF5")
    def test_a_missing_library_is_named(self):
        self.write("b.med", "")
        for extension, package in (("med", "libmedc-dev"), ("xdmf", "libhdf5-dev")):
            self.expect(2, self.box, "-o", f"a.{extension}", says=[f"{extension} needs .*; install .*{package}"])
            self.convert(2, self.box, "-o", "-", "--format", extension, says=[package])
        self.convert(3, "b.med", "-o", "b.vtu", says=["b.med: .med needs MED.*libmedc-dev"])

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
                # If no cell is marked, all cells at the crease count as its collar.
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


class Partitions(ProgramTest):
    """The options --partitions and --ghost-cells, in meshing and converting."""

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
        self.assertRegex(run.stderr, r"a_1\.vtu: cell \d+ occurs twice")
        listed = (self.folder / "a.pvtu").read_text()
        self.write("a.pvtu", listed.replace("a_1.vtu", "a_0.vtu"))
        run = self.run_program("info", "a.pvtu")
        self.assertEqual(run.returncode, 3)
        self.assertIn("two pieces have the same Source, a_0.vtu", run.stderr)
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
        self.expect(2, self.box, "-o", self.out, "--cell-decomposition",
                    "list", says=["say how many with --partitions"])
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
