"""Inputs: files that cannot be read, hostile ones, complexes that are none, meshes of other programs.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import resource
import shutil
import subprocess
import unittest

from program import BOX_FACES, COORDINATES, PROGRAM, ProgramTest, box_points, off_text


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
    """Headers that claim two thousand million entities: exit code 3 within a gigabyte of address space."""

    FILES = {
        "off": "OFF\n2000000000 2000000000 0\n0 0 0\n",
        "ply": "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\n"
               "property float z\nelement face 2000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
        "stl": " " * 80 + "\x7f\x7f\x7f\x7f" + "\0" * 50,
        "om": "OMT\x40\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f",
        "obj": "v 0 0 0\nf 1 2000000000 3\n",
        "poly": "2000000000 3 0 0\n1 0 0 0\n",
        "smesh": "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n2000000000 0\n3 1 2 3\n",
        "vtk": "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2000000000 double\n\0\0\0\0",
        "vtu": '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="2000000000" '
               'NumberOfCells="2000000000"><Points><DataArray type="Float64" NumberOfComponents="3">0 0 0</DataArray>'
               '</Points></Piece></UnstructuredGrid></VTKFile>',
        "msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2000000000\n1 0 0 0\n$EndNodes\n",
        "mesh": "MeshVersionFormatted 2\nDimension 3\nVertices 2000000000\n0 0 0 1\n",
        "inp": "*NODE\n1, 0, 0, 0\n*ELSET, ELSET=X, GENERATE\n1, 2000000000, 1\n",
        "unv": "    -1\n  2467\n         1         0         0         0         0         0         0 200000000\n"
               "name\n    -1\n",
        "ele": "2000000000 4 0\n1 1 2 3 4\n",
    }

    def test_claims_of_gigabytes(self):
        limit = 1 << 30
        self.write("a.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n")
        for extension, text in self.FILES.items():
            with self.subTest(extension=extension):
                (self.folder / f"a.{extension}").write_bytes(text.encode("latin-1"))
                run = subprocess.run([PROGRAM, "info", f"a.{extension}"], cwd=self.folder, timeout=60,
                                     capture_output=True, text=True,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
                self.assertEqual(run.returncode, 3, run.stderr)
                self.assertRegex(run.stderr, rf"a\.{extension}: (line|byte) \d+: ")


class InvalidComplex(ProgramTest):
    def test_open_surface(self):
        model = self.write("open.off", off_text(box_points(), BOX_FACES[1:]))
        self.expect(4, model, "-o", self.out, "--repair", "none", says=[COORDINATES, "Leave out --repair none"])

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


class InABox(ProgramTest):
    """Inputs that enclose nothing: points, segments, an open surface."""

    WIRES = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0.5 0.4 0.2\n4 0.5 0.4 0.9\n2 1\n1 0 5\n2 1 2\n1 0 6\n2 3 4\n0\n0\n"

    def meshed(self, path):
        self.expect(0, path, "-o", self.out, "--domain", "box",
                    says=[r"region 1: volume", "every guarantee holds"], writes=True)
        self.expect(0, "check", self.out, "--against", path, "--domain", "box", writes=True)

    def test_points(self):
        self.meshed(self.write("points.poly", "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 0.5 0.2\n0 0\n0\n0\n"))

    def test_wires(self):
        path = self.write("wires.poly", self.WIRES)
        self.meshed(path)
        self.expect(4, path, "-o", self.folder / "none.vtu", says=["enclose"], writes=True)
        info = json.loads(self.run_program("info", path, "--json", "--domain", "box", "--box-margin", "2").stdout)
        self.assertAlmostEqual(info["complex"]["regions"][0]["volume"], 5 * 4.4 * 4.9)

    def test_open_surface(self):
        self.meshed(self.write("sheet.off", off_text([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])))


class MeshesOfOtherPrograms(ProgramTest):
    """Meshes of other programs pass, or fail for their elements, but not for their labels."""

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
        for extension, format_name in (("msh", "msh41"), ("msh", "msh22"), ("mesh", "mesh"), ("unv", "unv"),
                                       ("vtk", "vtk"), ("inp", "inp")):
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


if __name__ == "__main__":
    unittest.main()
