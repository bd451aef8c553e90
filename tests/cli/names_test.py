"""Numbers and names of patches from input to output, surfaces in mesh files, and units, as users see them."""

import collections
import itertools
import json
import math
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import unittest

from program import BOX_FACES, MODELS, PROGRAM, SOURCES, ProgramTest, box_points, off_text

sys.path.append(str(SOURCES / "tests/support"))
from step_file import StepFile  # noqa: E402

MODULES = pathlib.Path(PROGRAM).parents[1] / "lib" / "collarmesh"
HAS_HDF5 = (MODULES / "collarmesh_hdf5.so").exists()
HAS_MED = "needs MED" not in subprocess.run([PROGRAM, "no input.off", "-o", "a.med"], capture_output=True,
                                            text=True).stderr
HAS_SCOTCH = (MODULES / "collarmesh_scotch.so").exists()
HAS_CAD = any(MODULES.glob("collarmesh_cad*"))


def faces_by_tag(path):
    import meshio

    mesh = meshio.read(path)
    tags = {}
    for block, tag in zip(mesh.cells, mesh.cell_data["tag"]):
        if block.type == "triangle":
            for each in tag:
                tags[int(each)] = tags.get(int(each), 0) + 1
    return tags


class Numbers(ProgramTest):
    def patches(self, *inputs):
        info = json.loads(self.run_program("info", "--json", *inputs).stdout)
        return {patch["tag"]: patch for patch in info["complex"]["patch_list"]}

    def test_info_and_formats_agree(self):
        patches = self.patches(MODELS / "bracket.off")
        self.assertGreater(len(patches), 6)
        self.assertEqual(sorted(patches), list(range(1, len(patches) + 1)))
        listed = self.run_program("info", MODELS / "bracket.off").stdout
        self.assertIn("patch 3: planar, area", listed)
        out = self.folder / "bracket.vtk"
        self.assertEqual(self.run_program(MODELS / "bracket.off", "-o", out, "--size", "6").returncode, 0)
        self.assertEqual(set(faces_by_tag(out)), set(patches))
        self.run_program(MODELS / "bracket.off", "-o", self.folder / "bracket.inp", "--size", "6")
        names = set(re.findall(r"SURFACE, NAME=PATCH_(\d+)", (self.folder / "bracket.inp").read_text()))
        self.assertEqual({int(n) for n in names}, set(patches))

    def test_info_lists_curves_of_the_input(self):
        info = json.loads(self.run_program("info", "--json", self.box).stdout)["complex"]["curve_list"]
        self.assertEqual([curve["tag"] for curve in info], list(range(1, 13)))
        self.assertEqual({curve["length"] for curve in info}, {1})
        listed = self.run_program("info", self.box).stdout
        for curve in info:
            place = ", ".join(f"{x:g}" for x in curve["where"])
            self.assertIn(f"curve {curve['tag']}: straight, length 1, at ({place})", listed)

    def test_these_numbers_of_curves_are_those_of_sizes(self):
        curve = json.loads(self.run_program("info", "--json", self.box).stdout)["complex"]["curve_list"][6]
        self.run_program(self.box, "-o", "a.vtu", "--size", "1", "--curve-size", f"{curve['tag']}=0.05")
        mesh = json.loads(self.run_program("info", "--json", "a.vtu").stdout)["mesh"]
        finest = max(mesh["curve_list"], key=lambda each: each["edges"])
        self.assertEqual(finest["tag"], curve["tag"])
        self.assertAlmostEqual(finest["length"], 1)

    def test_info_lists_faces_and_curves_of_a_mesh(self):
        self.run_program(self.box, "-o", "a.vtu", "--size", "0.5", "--names", '{"patches": {"fixed": 3}}')
        mesh = json.loads(self.run_program("info", "--json", "a.vtu").stdout)["mesh"]
        self.assertEqual([(p["tag"], p["name"]) for p in mesh["patch_list"]],
                         [(n, "fixed" if n == 3 else None) for n in range(1, 7)])
        for patch in mesh["patch_list"]:
            self.assertAlmostEqual(patch["area"], 1)
        self.assertEqual(sum(p["triangles"] for p in mesh["patch_list"]), mesh["faces"])
        self.assertEqual(sum(c["edges"] for c in mesh["curve_list"]), mesh["edges"])
        self.assertIn("patch 3 (fixed): ", self.run_program("info", "a.vtu").stdout)

    @unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
    def test_cad_shapes_have_names_of_faces_and_edges(self):
        listed = self.run_program("info", MODELS / "flange.step").stdout
        self.assertIn("patch 3 (Face3): smooth", listed)
        self.assertIn("curve 2 (Edge2): ", listed)
        info = json.loads(self.run_program("info", "--json", MODELS / "flange.step").stdout)["complex"]
        self.assertEqual({p["name"] for p in info["patch_list"]}, {f"Face{n}" for n in range(1, 13)})
        self.assertTrue(all(c["name"] == f"Edge{c['tag']}" for c in info["curve_list"]))

    def test_patch_sizes_by_these_numbers(self):
        out = self.folder / "box.vtk"
        for extra in ((), ("--patch-size", "3=0.1")):
            self.assertEqual(self.run_program(self.box, "-o", out, "--size", "0.5", *extra).returncode, 0)
            counts = faces_by_tag(out)
            if extra:
                self.assertGreater(counts[3], 4 * before[3])
            before = counts
        self.expect(2, self.box, "-o", self.out, "--patch-size", "7=0.1", says=["7", "1, 2, 3, 4, 5, 6"])

    def test_where_parts_touch_one_number_stays(self):
        """The summary says which number stays, and so does the error for an option that uses the other one."""
        parts = []
        for first, low in ((1, 0), (7, 1)):
            points = box_points((low, 0, 0), (low + 1, 1, 1))
            lines = [f"{len(points)} 3 0 0", *(f"{k} {p[0]} {p[1]} {p[2]}" for k, p in enumerate(points)), "6 1"]
            lines += [f"1 0 {first + k}\n4 " + " ".join(map(str, face)) for k, face in enumerate(BOX_FACES)]
            parts.append(self.write(f"{first}.poly", "\n".join([*lines, "0", "0"]) + "\n"))
        run = self.expect(0, *parts, "-o", self.out, "--size", "1", writes=True)
        self.assertIn("merged: 2 triangles that parts have in common; there patch 12 became patch 4\n", run.stderr)
        self.out.unlink()
        self.expect(2, *parts, "-o", self.out, "--patch-size", "12=0.2",
                    says=["patch 12 lies on patch 4 of another part, and both now have the number 4"])

    @unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
    def test_where_solids_of_a_file_touch_one_number_stays(self):
        file = StepFile()
        file.product("Left", file.box((0, 0, 0), (1, 1, 1)))
        file.product("Right", file.box((1, 0, 0), (2, 1, 1)))
        file.product("Top", file.box((0, 0, 1), (1, 1, 2)))
        part = file.write(self.folder / "touching.step")
        out = self.folder / "touching.vtu"
        run = self.run_program(part, "-o", out, "--size", "1")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("triangles that parts have in common; there patch 7 became patch 2, 17 became 6\n", run.stderr)
        use = "patch {} of another part, and both now have the number {}"
        self.expect(2, part, "-o", self.out, "--patch-size", "7=0.2", says=["patch 7 lies on " + use.format(2, 2)])
        self.expect(2, part, "-o", self.out, "--name", "contact=17", says=["patch 17 lies on " + use.format(6, 6)])

    def test_a_mesh_with_numbers_passes_check(self):
        self.expect(0, self.box, "-o", self.out, "--size", "0.5", writes=True)
        run = self.run_program("check", self.out, "--against", self.box)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertNotIn("note:", run.stdout)


class Names(ProgramTest):
    def stl(self):
        """Writes a box: its bottom is one solid of the file, its top another one, its sides a third."""
        import program as p

        points = p.box_points()
        solids = {"bottom plate": p.BOX_FACES[:1], "top": p.BOX_FACES[1:2], "walls": p.BOX_FACES[2:]}
        text = ""
        for name, faces in solids.items():
            text += f"solid {name}\n"
            for a, b, c, d in faces:
                for triangle in ((a, b, c), (a, c, d)):
                    corners = "".join("vertex %g %g %g\n" % points[i] for i in triangle)
                    text += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
            text += f"endsolid {name}\n"
        return self.write("box.stl", text)

    def test_solids_of_stl(self):
        self.run_program(self.stl(), "-o", self.folder / "a.inp", "--size", "0.5")
        text = (self.folder / "a.inp").read_text()
        self.assertEqual(set(re.findall(r"SURFACE, NAME=(\w+)", text)), {"BOTTOM_PLATE", "TOP", "WALLS"})
        self.run_program(self.stl(), "-o", self.folder / "a.msh", "--size", "0.5")
        self.assertIn('"bottom plate"', (self.folder / "a.msh").read_text())
        self.assertIn("patch 1 (bottom plate)", self.run_program("info", self.stl()).stdout)

    def test_two_files_with_names_keep_apart(self):
        first = self.stl()
        text = first.read_text().replace("walls", "sides")
        shifted = re.sub(r"vertex (\S+)", lambda m: f"vertex {float(m[1]) + 1:g}", text)
        second = self.write("other.stl", shifted)
        self.run_program(first, second, "-o", self.folder / "a.msh", "--size", "0.5")
        names = set(re.findall(r'^2 \d+ "(.*)"', (self.folder / "a.msh").read_text(), re.M))
        self.assertLessEqual({"bottom plate", "top", "walls", "sides"}, names)

    def test_names_by_number_and_point(self):
        names = {"patches": {"fixed": 1, "loaded": {"at": [0.5, 0.5, 1]}}, "regions": {"steel": 1}}
        path = self.write("names.json", json.dumps(names))
        out = self.folder / "a.inp"
        run = self.run_program(self.box, "-o", out, "--size", "0.5", "--names", path)
        self.assertEqual(run.returncode, 0, run.stderr)
        for word in ("NAME=FIXED,", "NSET=LOADED_NODES", "ELSET=STEEL"):
            self.assertIn(word, out.read_text())
        path.write_text('{"patches": {"fixed": 99}}')
        self.expect(2, self.box, "-o", self.out, "--names", path, says=["names.json", "patches.fixed", "99"])
        self.expect(3, self.box, "-o", self.out, "--names", "nmaes.json", says=["did you mean names.json"])


class GivenNames(ProgramTest):
    """The option --name, together with the JSON of --names."""

    def names(self, *arguments):
        run = self.run_program(self.box, "-o", "a.msh", "--size", "0.5", *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return set(re.findall(r'^(\d) (\d+) "(.*)"', (self.folder / "a.msh").read_text(), re.M))

    def test_patches_curves_and_regions(self):
        names = self.names("--name", "fixed=5", "--name", "walls=2,3",
                           "--name", "rim=curve:4", "--name", "steel=region:1")
        self.assertLessEqual({("2", "5", "fixed"), ("2", "2", "walls"), ("1", "4", "rim"), ("3", "1", "steel")}, names)
        self.assertNotIn(("2", "3", "patch_3"), names)

    def test_beside_the_json(self):
        path = self.write("names.json", '{"patches": {"fixed": 1, "walls": [2]}}')
        names = self.names("--names", path, "--name", "walls=3", "--name", "top=6")
        self.assertLessEqual({("2", "1", "fixed"), ("2", "2", "walls"), ("2", "6", "top")}, names)
        self.assertIn(("2", "5", "inline"), self.names("--names", '{"patches": {"inline": 5}}'))

    def test_mistakes(self):
        for text in ("fixed", "=3", "fixed=", "fixed=x", "fixed=face:1"):
            self.expect(2, self.box, "-o", self.out, "--name", text, says=[f"name: '{text}' is not NAME=NUMBER"])
        self.expect(2, self.box, "-o", self.out, "--name", "fixed=99", says=["patches.fixed", "99"])
        path = self.write("names.json", '{\n  "patches":\n    {"fixed" 1}\n}')
        self.expect(2, self.box, "-o", self.out, "--names", path,
                    says=["names.json: names: line 3, column 14: this is not JSON"])
        self.expect(2, self.box, "-o", self.out, "--names", path, "--name", "a=1", says=["line 3, column 14"])


@unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
class NamesOfStep(ProgramTest):
    def complex_of(self, path, *options):
        return json.loads(self.run_program("info", "--json", path, *options).stdout)["complex"]

    def names(self, path, *options):
        return [region["name"] for region in self.complex_of(path, *options)["regions"]]

    def two_solids(self):
        file = StepFile()
        file.product("Base plate", file.box((0, 0, 0), (4, 3, 1), colour=(1, 0, 0), face_colours={5: (0, 0, 1)}))
        file.product("Rib", file.box((0, 1, 1), (4, 2, 2), colour=(0, 0.5, 0)))
        return file.write(self.folder / "two.step")

    def test_solids_have_the_names_of_their_products(self):
        path = self.two_solids()
        self.assertEqual(self.names(path), ["Base plate", "Rib"])
        self.assertRegex(self.run_program("info", path).stdout, r"region 1 \(Base plate\): tag 1, volume 12 ")
        run = self.run_program(path, "-o", "a.vtu", "--report", "a.json", "--size", "1")
        self.assertRegex(run.stdout + run.stderr, r"region 2 \(Rib\): volume 4,")
        report = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(report["mesh"]["region_names"], {"1": "Base plate", "2": "Rib"})
        self.assertIn("region 1 (Base plate): ", self.run_program("info", "a.vtu").stdout)

    def test_every_format_with_names_has_them(self):
        self.run_program(self.two_solids(), "-o", "a.vtu", "--size", "1")
        expected = {"vtk": "Base plate", "msh": '"Base plate"', "msh2": '"Base plate"', "inp": "ELSET=BASE_PLATE",
                    "unv": "Base plate", "bdf": '"Base plate"', "cdb": "BASE_PLATE", "mfem": "Base plate",
                    "exo": "Base plate", **({"xdmf": "Base plate", "cgns": "Base plate"} if HAS_HDF5 else {})}
        for extension, name in expected.items():
            with self.subTest(extension=extension):
                self.assertEqual(self.run_program("convert", "a.vtu", "-o", f"a.{extension}").returncode, 0)
                self.assertIn(name.encode(), (self.folder / f"a.{extension}").read_bytes())

    def test_colours_are_in_reports(self):
        complex_ = self.complex_of(self.two_solids())
        self.assertEqual([region["colour"] for region in complex_["regions"]], ["#ff0000", "#008000"])
        colours = {patch["tag"]: patch["colour"] for patch in complex_["patch_list"]}
        self.assertEqual([colours[n] for n in range(1, 7)], ["#ff0000"] * 5 + ["#0000ff"])
        self.assertEqual({colour for n, colour in colours.items() if n > 6}, {"#008000"})
        plain = self.complex_of(MODELS / "flange.step")
        self.assertEqual({each["colour"] for each in plain["patch_list"] + plain["regions"]}, {None})

    def test_solids_of_one_product(self):
        file = StepFile()
        file.product("Rig", file.box((0, 0, 0), (1, 1, 1), "Body1"), file.box((2, 0, 0), (3, 1, 1), "Body2"))
        self.assertEqual(self.names(file.write(self.folder / "a.step")), ["Body1", "Body2"])
        file.product("Pin", file.box((4, 0, 0), (5, 1, 1), "Body1"))
        self.assertEqual(self.names(file.write(self.folder / "a.step")), ["Rig Body1", "Rig Body2", "Pin"])

    def test_parts_of_assemblies(self):
        file = StepFile()
        bolt = file.product("Bolt", file.box((0, 0, 0), (1, 1, 1)))
        pair = file.assembly("Pair", (bolt, (0, 0, 0)), (bolt, (2, 0, 0)))
        file.assembly("Rig", (file.assembly("Row", (pair, (0, 0, 0)), (pair, (0, 2, 0))), (5, 0, 0)))
        self.assertEqual(self.names(file.write(self.folder / "a.step")), ["Bolt", "Bolt_2", "Bolt_3", "Bolt_4"])

    def test_given_names_win(self):
        path = self.two_solids()
        self.assertEqual(self.names(path, "--name", "steel=region:2"), ["Base plate", "steel"])
        self.assertEqual(self.names(path, "--name", "base_plate=region:2"), ["Base plate_2", "base_plate"])

    def test_names_that_say_nothing_or_cannot_be_written(self):
        file = StepFile()
        names = ["", "Solid3", "patch_1", "a\"b", "  x  ", "caf\\X\\E9", "\udc80\udcff", "y" * 200, "O''Hara", "X"]
        for k, name in enumerate(names):
            file.product(name, file.box((2 * k, 0, 0), (2 * k + 1, 1, 1)))
        found = self.names(file.write(self.folder / "a.step"))
        self.assertEqual(found, ["Solid1", "Solid2", "Solid3", "a_b", "x", "café", "\x80ÿ", "y" * 60, "O'Hara", "X_2"])
        self.run_program(self.folder / "a.step", "-o", "a.vtu", "--size", "2")
        for extension in ["msh", "inp", "cdb", "exo"] + ["xdmf", "cgns"] * HAS_HDF5 + ["med"] * HAS_MED:
            with self.subTest(extension=extension):
                self.assertEqual(self.run_program("convert", "a.vtu", "-o", f"a.{extension}").returncode, 0)

    def test_numbers_of_several_files_have_no_names(self):
        file = StepFile()
        file.product("Other", file.box((9, 0, 0), (10, 1, 1)))
        self.assertEqual(set(self.names(self.two_solids(), file.write(self.folder / "b.step"))), {"Solid1", "Solid2"})


@unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
class WiresOfCadFiles(ProgramTest):
    """A circle (Edge13) and a point inside a box, and a needle (Edge14) that protrudes from its top."""

    MODEL = MODELS / "wires_in_box.brep"
    LOOP, NEEDLE = 13, 14

    def meshed(self, *options):
        import meshio

        run = self.run_program(self.MODEL, "-o", "a.msh", "--size", "5", *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, r"Edge14 at \(10, 10, 18\) is partly outside of the closed solids")
        self.assertIn("every guarantee holds", run.stderr)
        mesh = meshio.read(self.folder / "a.msh")
        tags = mesh.cell_data["gmsh:physical"]
        return mesh, [(line, tag) for block, of_block in zip(mesh.cells, tags) if block.type.startswith("line")
                      for line, tag in zip(block.data.tolist(), of_block.tolist())]

    def sides_of_tets(self, mesh):
        return {frozenset(side) for block in mesh.cells if block.type.startswith("tetra")
                for tet in block.data.tolist() for side in itertools.combinations(tet[:4], 2)}

    def test_nodes_lie_on_them(self):
        for order in ("1", "2"):
            mesh, lines = self.meshed("--curve-size", f"{self.LOOP}=1", "--order", order)
            sides = self.sides_of_tets(mesh)
            for nodes, tag in lines:
                self.assertIn(frozenset(nodes[:2]), sides)
                for x, y, z in mesh.points[nodes].tolist():
                    if tag == self.LOOP:
                        self.assertAlmostEqual(math.hypot(x - 10, y - 10), 6, places=9)
                        self.assertAlmostEqual(z, 10, places=9)
                    elif tag == self.NEEDLE:
                        self.assertEqual((x, y), (10, 10))
            loop, needle = ([nodes for nodes, tag in lines if tag == each] for each in (self.LOOP, self.NEEDLE))
            self.assertGreater(len(loop), 2 * math.pi * 6 / 2.5)  # finer than the rest
            self.assertEqual(set(collections.Counter(node for nodes in loop for node in nodes[:2]).values()), {2})
            heights = sorted(z for z in mesh.points[sorted({n for nodes in needle for n in nodes[:2]})][:, 2].tolist())
            self.assertEqual((heights[0], heights[-1], len(heights)), (12, 20, len(needle) + 1))
            self.assertIn([4, 10, 14], mesh.points.tolist())

    def test_they_have_names(self):
        mesh, lines = self.meshed("--name", "needle=curve:14")
        self.assertEqual({tag for _, tag in lines}, set(range(1, 15)))
        names = {name: list(number) for name, number in mesh.field_data.items()}
        self.assertEqual((names["Edge13"], names["needle"]), ([13, 1], [14, 1]))
        info = json.loads(self.run_program("info", "--json", self.MODEL).stdout)["complex"]["curve_list"]
        lengths = {curve["name"]: curve["length"] for curve in info}
        self.assertAlmostEqual(lengths["Edge14"], 8)


@unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
class CoilOfACadFile(ProgramTest):
    def test_it_is_one_chain_on_the_helix(self):
        import meshio

        run = self.run_program(MODELS / "coil_in_box.brep", "-o", "a.msh", "--size", "5", "--curve-size", "13=1.2")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("every guarantee holds", run.stderr)
        mesh = meshio.read(self.folder / "a.msh")
        lines = {tag: [] for tag in (13, 14, 15)}
        for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            if block.type == "line":
                for line, tag in zip(block.data.tolist(), tags.tolist()):
                    lines.get(tag, []).append(line)
        radius, pitch = 6, 3
        for node in {node for line in lines[13] for node in line}:
            x, y, z = mesh.points[node].tolist()
            self.assertAlmostEqual(math.hypot(x, y), radius, places=5)
            turn = (z + 7.5) / pitch
            self.assertAlmostEqual(math.dist((x, y), (radius * math.cos(2 * math.pi * turn),
                                                      radius * math.sin(2 * math.pi * turn))), 0, places=5)
        uses = collections.Counter(node for of_tag in lines.values() for line in of_tag for node in line)
        self.assertEqual(sorted(uses.values())[:2], [1, 1])
        self.assertEqual(set(sorted(uses.values())[2:]), {2})
        ends = sorted(mesh.points[[node for node, count in uses.items() if count == 1]].tolist())
        self.assertEqual([[round(x, 9) for x in end] for end in ends], [[20, 0, -7.5], [20, 0, 7.5]])


@unittest.skipUnless(HAS_MED, "no MED")
class NamesInMed(ProgramTest):
    def test_families_end_at_a_character(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("no h5py")
        for first in ("y", "yy"):
            run = self.run_program(self.box, "-o", "a.med", "--size", "1", "--name", f"{first}{'é' * 40}=1")
            self.assertEqual(run.returncode, 0, run.stderr)
            names = []
            with h5py.File(self.folder / "a.med") as file:
                file["FAS"].visit(names.append)
            self.assertTrue(any("FAM_" in name and "éé" in name for name in names), names)
            for name in names:
                name.encode()  # a half character cannot be encoded


class NamesThroughFormats(ProgramTest):
    """A name that a format can store survives conversion to another one; lost names are reported."""
    NAMES = {"patches": {"Fixed end": 1, "loaded": {"at": [0.5, 0.5, 1]}}, "curves": {"rim": 4},
             "regions": {"steel": 1}}
    KEEP = ["vtu", "vtk", "pvtu", "msh", "msh2", "unv"] + ["xdmf"] * HAS_HDF5 + ["med"] * HAS_MED

    def names_in_msh(self, mesh):
        run = self.run_program("convert", mesh, "-o", "names.msh")
        self.assertEqual(run.returncode, 0, run.stderr)
        found = re.findall(r'^(\d) \d+ "(.*)"', (self.folder / "names.msh").read_text(), re.M)
        return {(int(dimension), name) for dimension, name in found}

    def setUp(self):
        super().setUp()
        self.names = self.write("names.json", json.dumps(self.NAMES))
        self.all = {(2, "Fixed end"), (2, "loaded"), (1, "rim"), (3, "steel")}

    def mesh(self, path):
        run = self.run_program(self.box, "-o", path, "--size", "0.5", "--names", self.names)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stderr

    def test_from_each_format_to_the_next(self):
        self.mesh("a.vtu")
        for extension in self.KEEP:
            with self.subTest(extension=extension):
                run = self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertNotIn("names", run.stderr)
                self.assertLessEqual(self.all, self.names_in_msh(f"b.{extension}"))

    def test_of_partitions(self):
        self.mesh("a.vtu")
        if HAS_SCOTCH:
            self.run_program("convert", "a.vtu", "-o", "b.pvtu", "--partitions", "3")
            self.assertLessEqual(self.all, self.names_in_msh("b.pvtu"))

    def test_abaqus_keeps_names_of_faces_and_regions(self):
        self.write("two.off", off_text(box_points((0, 0, 1), (1, 1, 2)), BOX_FACES))
        names = self.write("regions.json", '{"patches": {"bottom": 2}, "regions": {"steel": 1, "copper": 2}}')
        self.run_program(self.box, "two.off", "-o", "a.inp", "--size", "0.5", "--names", names)
        found = self.names_in_msh("a.inp")
        self.assertLessEqual({(2, "BOTTOM"), (3, "STEEL"), (3, "COPPER")}, found)
        self.assertNotIn("EALL", {name for _, name in found})
        regions = json.loads(self.run_program("info", "--json", "a.inp").stdout)["mesh"]["region_volumes"]
        self.assertEqual(len(regions), 2)

    def test_sets_of_abaqus_are_all_different(self):
        self.write("two.off", off_text(box_points((0, 0, 1), (1, 1, 2)), BOX_FACES))
        pairs = {("1st part", "N 1st part"): ["N_1ST_PART", "N_1ST_PART_2"],
                 ("EALL", "steel"): ["EALL_2", "STEEL"], ("Volume_2", "x"): ["VOLUME_2_2", "X"],
                 ("x", "Volume_9"): ["X", "VOLUME_9_2"]}
        for pair, sets in pairs.items():
            with self.subTest(pair=pair):
                names = self.write("regions.json", json.dumps({
                    "patches": {"rim": 2}, "curves": {"rim": 4}, "regions": {pair[0]: 1, pair[1]: 2}}))
                run = self.run_program(self.box, "two.off", "-o", "a.inp", "--size", "0.5", "--names", names)
                self.assertEqual(run.returncode, 0, run.stderr)
                text = (self.folder / "a.inp").read_text()
                found = re.findall(r"ELSET=(\w+)$", text, re.M)
                self.assertEqual(found, ["VOLUME_1", "VOLUME_2", "EALL", *sets])
                nodes = re.findall(r"NSET=(\w+)$", text, re.M)
                self.assertEqual(len(nodes), len(set(nodes)))
                self.assertLessEqual({"RIM_NODES", "RIM_2_NODES"}, set(nodes))
                mesh = json.loads(self.run_program("info", "--json", "a.inp").stdout)["mesh"]
                self.assertEqual(list(mesh["region_volumes"]), ["1", "2"])

    def test_a_loss_is_told(self):
        self.mesh("a.vtu")
        for extension in ("mesh", "ele"):
            run = self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
            self.assertRegex(run.stderr, "no place for: .*4 names of groups")
            self.assertIn(f"--names: .{extension} has no place for names", self.mesh(f"c.{extension}"))
        for extension in ("stl", "off", "ply"):
            run = self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
            self.assertRegex(run.stderr, "no place for: .*2 names of patches")
        self.run_program("convert", "a.vtu", "-o", "b.obj")
        self.assertIn("g Fixed_end", (self.folder / "b.obj").read_text())

    @unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
    def test_faces_of_cad_shapes(self):
        self.run_program(MODELS / "flange.step", "-o", "a.vtu", "--size", "10")
        for extension in ["vtu", "vtk", "msh", "unv"] + ["xdmf"] * HAS_HDF5 + ["med"] * HAS_MED:
            with self.subTest(extension=extension):
                self.run_program("convert", "a.vtu", "-o", f"b.{extension}")
                names = self.names_in_msh(f"b.{extension}")
                self.assertLessEqual({(2, "Face3"), (1, "Edge1"), (3, "Solid1")}, names)
        self.run_program("convert", "a.vtu", "-o", "b.inp")
        self.assertIn("SURFACE, NAME=FACE3", (self.folder / "b.inp").read_text())

    def test_meshio_finds_them(self):
        if not HAS_HDF5:
            self.skipTest("no HDF5")
        import meshio

        self.mesh("a.xdmf")
        data = meshio.read(self.folder / "a.xdmf").field_data
        self.assertEqual({(int(d), name) for name, (_, d) in data.items()}, self.all)
        for extension in ("vtu", "vtk"):  # names stored beside the cells do no harm
            self.mesh(f"a.{extension}")
            self.assertGreater(len(meshio.read(self.folder / f"a.{extension}").points), 8)


class Surfaces(ProgramTest):
    def test_surfaces_in_mesh_files(self):
        """Tagged surfaces saved by gmsh and meshio are meshed with their tags."""
        import meshio
        import numpy
        import program as p

        points = numpy.array(p.box_points(), dtype=float)
        triangles = numpy.array([t for a, b, c, d in p.BOX_FACES for t in ((a, b, c), (a, c, d))])
        tags = numpy.repeat(numpy.arange(11, 17), 2)
        gmsh = {"gmsh:physical": [tags], "gmsh:geometrical": [tags]}
        meshio.Mesh(points, [("triangle", triangles)], cell_data=gmsh).write(
            self.folder / "box.msh", file_format="gmsh22", binary=False)
        meshio.Mesh(points, [("triangle", triangles)], cell_data={"medit:ref": [tags]}).write(self.folder / "box.mesh")
        meshio.Mesh(points, [("triangle", triangles)], cell_data={"tag": [tags]}).write(self.folder / "box.vtu")
        self.write_vtp(points, triangles, tags)
        for name in ("box.msh", "box.mesh", "box.vtu", "box.vtp"):
            with self.subTest(name=name):
                out = self.folder / "out.vtk"
                run = self.run_program(self.folder / name, "-o", out, "--size", "0.5")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(set(faces_by_tag(out)), set(range(11, 17)))
                info = self.run_program("info", self.folder / name).stdout
                self.assertIn("volume 1", info)
                run = self.run_program("convert", self.folder / name, "-o", self.folder / "back.ply")
                self.assertEqual(run.returncode, 0, run.stderr)

    def write_vtp(self, points, triangles, tags):
        try:
            import vtk
            from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        except ImportError:
            self.skipTest("python3-vtk9 is not installed")
        import numpy

        data, nodes, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        nodes.SetData(numpy_to_vtk(points, deep=True))
        flat = numpy.hstack([numpy.full((len(triangles), 1), 3), triangles]).ravel()
        cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(flat.astype(numpy.int64), deep=True))
        data.SetPoints(nodes)
        data.SetPolys(cells)
        array = numpy_to_vtk(tags.astype(numpy.int32), deep=True)
        array.SetName("tag")
        data.GetCellData().AddArray(array)
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetFileName(str(self.folder / "box.vtp"))
        writer.SetInputData(data)
        writer.Write()


class Units(ProgramTest):
    def test_scale(self):
        import meshio

        for name, scale in (("a.vtu", "0.001"), ("b.vtu", "1")):
            self.assertEqual(self.run_program(self.box, "-o", self.folder / name,
                             "--size", "0.5", "--scale", scale).returncode, 0)
        small, large = (meshio.read(self.folder / name) for name in ("a.vtu", "b.vtu"))
        self.assertTrue((small.points == 0.001 * large.points).all())
        self.run_program("convert", self.box, "-o", self.folder / "c.off", "--scale", "1000")
        self.assertIn("diagonal 1732.05", self.run_program("info", self.folder / "c.off").stdout)
        self.run_program("convert", self.folder / "b.vtu", "-o", self.folder / "c.vtu", "--scale", "0.001")
        self.assertTrue((meshio.read(self.folder / "c.vtu").points == small.points).all())


class Words(ProgramTest):
    def test_typos_in_commands(self):
        for typo, command in (("chek", "check"), ("inof", "info"), ("convrt", "convert"), ("repiar", "repair")):
            self.expect(2, typo, self.box, says=[f"{typo}: there is no such command or file; did you mean {command}"])
        self.write("chek", "a file")
        self.expect(3, "chek", "-o", self.out, says=["can be read from a file with the extension"])

    def test_help_says_what_commands_do(self):
        for command, words in (("check", "Certify a mesh"), ("info", "Describe the input"),
                               ("convert", "Convert surfaces"), ("repair", "Write the facets")):
            self.assertIn(words, self.expect(0, command, "--help").stdout)

    def test_standard_output_names_convert(self):
        self.expect(2, self.box, "-o", "-", says=["convert IN"])

    def test_a_format_by_its_name(self):
        run = self.run_program(self.box, "-o", self.folder / "box.gmsh", "--format", "msh2", "--size", "0.5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((self.folder / "box.gmsh").read_text().startswith("$MeshFormat\n2.2"))


class Generated(ProgramTest):
    def test_manual_page(self):
        page = self.run_program("--generate", "man").stdout
        path = self.write("collarmesh.1", page)
        for option in re.findall(r"--[a-z][a-z-]+", self.run_program("--help").stdout):
            self.assertIn(option.replace("-", "\\-"), page)
        if shutil.which("man"):
            run = subprocess.run(["man", "--warnings", "-l", path], capture_output=True, text=True,
                                 env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"})
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertIn("--patch-size TAG=LENGTH", run.stdout)

    def complete(self, *words):
        path = self.write("completion", self.run_program("--generate", "bash").stdout)
        script = f"source {path}; COMP_WORDS=({' '.join(words)} ''); COMP_CWORD={len(words)}; "
        if words[-1] != "--coarsen":
            script = f"source {path}; COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; "
        run = subprocess.run(["bash", "-c", script + '_collarmesh; echo "${COMPREPLY[@]}"'], capture_output=True,
                             text=True, cwd=self.folder)
        self.assertEqual(run.stderr, "")
        return run.stdout.split()

    def test_completion(self):
        self.assertEqual(self.complete("collarmesh", "--patch"), ["--patch-size"])
        self.assertEqual(self.complete("collarmesh", "check", "--again"), ["--against"])
        self.assertEqual(self.complete("collarmesh", "conv"), ["convert"])
        self.assertEqual(self.complete("collarmesh", "box.off", "--coarsen"), ["on", "off"])

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_completion_by_fish(self):
        path = self.write("collarmesh.fish", self.run_program("--generate", "fish").stdout)

        def complete(line):
            run = subprocess.run(["fish", "--no-config", "-c", f"source {path}; complete -C '{line}'"],
                                 capture_output=True, text=True, cwd=self.folder,
                                 env={**os.environ, "HOME": str(self.folder)})
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            return [line.split("\t")[0] for line in run.stdout.splitlines()]

        self.assertEqual(complete("collarmesh --patch"), ["--patch-size"])
        self.assertEqual(complete("collarmesh check --again"), ["--against"])
        self.assertEqual(complete("collarmesh check --patch"), [])
        self.assertEqual(complete("collarmesh conv"), ["convert"])
        self.assertEqual(complete("collarmesh box.off --coarsen o"), ["off", "on"])
        self.assertIn("box.off", complete("collarmesh bo"))

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_completion_by_zsh(self):
        """Types a line up to the tab; the shell then calls a function that prints its arguments."""
        self.write("_collarmesh", self.run_program("--generate", "zsh").stdout)
        setup = ("PS1=; PS2=; fpath=($PWD $fpath); autoload -U compinit; compinit -u -D; setopt no_beep no_prompt_cr; "
                 "collarmesh() { print -r -- \"<$*>\" }; print ready\n")
        for typed, completed in (("collarmesh --patch-s", "--patch-size"),
                                 ("collarmesh check --again", "check --against"), ("collarmesh conv", "convert"),
                                 ("collarmesh box.off --coarsen of", "box.off --coarsen off"),
                                 ("collarmesh bo", "box.off")):
            with self.subTest(typed=typed):
                self.assertIn(f"<{completed}>", self.typed(["zsh", "-f", "-i"], setup, f"{typed}\t\n"))

    def typed(self, shell, setup, keys):
        """Returns what an interactive shell shows when this is typed, up to the function's answer."""
        master, slave = pty.openpty()
        run = subprocess.Popen(shell, stdin=slave, stdout=slave, stderr=slave, cwd=self.folder, start_new_session=True,
                               env={**os.environ, "HOME": str(self.folder), "TERM": "dumb"})
        os.close(slave)
        try:
            shown = self.answer(master, setup, r"\nready")
            return shown + self.answer(master, keys, r"<[^$]*>")
        finally:
            run.kill()
            run.wait()
            os.close(master)

    def answer(self, terminal, keys, expected):
        os.write(terminal, keys.encode())
        shown = ""
        while not re.search(expected, shown.replace("\r", "")):
            if not select.select([terminal], [], [], 60)[0]:
                self.fail(f"no answer to {keys!r}: {shown}")
            shown += os.read(terminal, 4096).decode(errors="replace")
        return shown


if __name__ == "__main__":
    unittest.main()
