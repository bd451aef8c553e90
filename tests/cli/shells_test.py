"""Surfaces and curves on their own on the command line: open ones, formats, the certificate of a file, some faces of a
solid, elements of a plane, lines for beams, what is wrong.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import unittest

from program import BOX_FACES, COORDINATES, MODELS, ProgramTest, box_points, off_text

SQUARE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
# Four points and three lines; the last two lines have the same tag.
WIRE = "4 3 0 1\n1 0 0 0 0\n2 10 0 0 0\n3 10 10 0 0\n4 10 10 5 0\n3 1\n" + "".join(
    f"1 0 {tag}\n2 {a} {a + 1}\n" for a, tag in ((1, 7), (2, 8), (3, 9))) + "0\n0\n"


def elements_of(path):
    """Returns {type: [nodes]} of an .inp file."""
    found, kind = {}, None
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            kind = line.split("TYPE=")[1].split(",")[0] if line.startswith("*ELEMENT") else None
        elif kind:
            found.setdefault(kind, []).append(tuple(map(int, line.split(",")[1:])))
    return found


class Shells(ProgramTest):
    def setUp(self):
        super().setUp()
        self.open = self.write("open.off", off_text(box_points(), BOX_FACES[:-1]))

    def test_an_open_surface_is_meshed_and_certified(self):
        square = self.write("square.off", off_text(box_points()[:4], [(0, 1, 2, 3)]))
        self.expect(4, square, "-o", self.out, "--size", "0.2", says=["--dimension 2"])
        self.expect(0, square, "-o", "square.vtu", "--size", "0.2", "--dimension", "2")
        self.expect(0, self.open, "-o", self.out, "--size", "0.2", "--dimension", "2", "--report", "r.json",
                    says=["triangles", "every guarantee holds"], writes=True)
        check = json.loads((self.folder / "r.json").read_text())["check"]
        self.assertGreaterEqual(check["triangles"]["min_angle"], 20)
        self.assertLessEqual(check["triangles"]["max_angle"], 120)
        self.assertAlmostEqual(sum(k["mesh"] for k in check["kept"]["patch_areas"]), 5, 9)
        for name in ("out.vtu", "next.msh", "next.mesh"):
            self.run_program(self.open, "-o", name, "--size", "0.2", "--dimension", "2")
            run = self.run_program("check", name, "--against", self.open)
            self.assertEqual(run.returncode, 0, name + run.stdout + run.stderr)
        self.assertNotEqual(self.run_program("check", "out.vtu", "--against", self.box).returncode, 0)

    def test_formats(self):
        for name in ("a.stl", "a.off", "a.obj", "a.vtk", "a.msh", "a.msh2", "a.mesh", "a.inp", "a.unv"):
            run = self.run_program(self.box, "-o", name, "--size", "0.3", "--dimension", "2")
            self.assertEqual(run.returncode, 0, name + run.stderr)
            self.assertGreater((self.folder / name).stat().st_size, 1000)
        text = (self.folder / "a.inp").read_text()
        self.assertIn("TYPE=S3, ELSET=PATCH_1", text)
        self.assertNotIn("C3D4", text)
        self.run_program(self.box, "-o", "b.inp", "--size", "0.3", "--dimension", "2", "--order", "2")
        self.assertIn("TYPE=S6", (self.folder / "b.inp").read_text())

    def test_what_is_wrong_is_told(self):
        self.expect(2, self.box, "-o", "a.su2", "--dimension", "2", says=["no place for triangles alone"])
        self.expect(2, self.box, "-o", "a.stl", "--dimension", "2", "--order", "2", says=["second order"])
        self.expect(2, self.box, "-o", "a.vtu", "--dimension", "4", says=["--dimension"])

    def test_formats_without_curves_are_not_checked(self):
        self.expect(0, self.box, "-o", "a.off", "--size", "0.3", "--dimension", "2")
        self.expect(3, "check", "a.off", "--against", self.box, says=["no edges on curves", r"\.vtu", r"\.msh"])

    def test_some_faces_of_a_solid(self):
        named = (self.box, "--dimension", "2", "--size", "0.3", "--name", "lid=2")
        self.expect(0, *named, "--faces", "lid", "--faces", "patch_3",
                    "-o", self.out, "--report", "r.json", writes=True)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual([each["tag"] for each in report["complex"]["patch_list"]], [2, 3])
        areas = report["check"]["kept"]["patch_areas"]
        self.assertEqual([round(each["mesh"], 9) for each in areas], [1, 1])
        against = ("check", self.out, "--against", self.box, "--name", "lid=2")
        self.assertEqual(self.run_program(*against, "--faces", "lid", "--faces", "3").returncode, 0)
        self.assertEqual(self.run_program(*against).returncode, 7)
        self.assertEqual(self.run_program(*against, "--faces", "lid").returncode, 7)
        self.assertEqual(self.run_program(*against, "--faces", "lid", "--faces", "4").returncode, 7)
        wrong = self.run_program(*against, "--faces", "base")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("no patch is called 'base'", wrong.stderr)
        self.out.unlink()
        self.expect(2, *named, "--faces", "base", "-o", self.out,
                    says=["no patch is called 'base'", r"1, 2 \(lid\), 3"])
        self.expect(2, self.box, "--faces", "1", "-o", self.out, says=["faces are for triangles alone"])

    def test_faces_of_a_cad_solid(self):
        run = self.run_program(MODELS / "flange.step", "-o", "f.msh", "--dimension", "2", "--size", "4", "--faces",
                               "Face3", "--order", "2", "--report", "r.json")
        if "OpenCASCADE" in run.stderr:
            self.skipTest("without OpenCASCADE")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual([each["tag"] for each in report["complex"]["patch_list"]], [3])
        self.assertGreater(report["projection"]["vertices"], 0)

    def test_elements_of_a_plane(self):
        """Elements are counterclockwise in the plane z = 0, whichever way the input is oriented."""
        for corners, kind, order, element in ((SQUARE, "plane-stress", 1, "CPS3"),
                                              (SQUARE[::-1], "plane-strain", 2, "CPE6")):
            square = self.write("square.off", off_text(corners, [(0, 1, 2, 3)]))
            run = self.run_program(square, "-o", "s.inp", "--dimension", "2", "--size", "0.5", "--order", order,
                                   "--triangle-elements", kind)
            self.assertEqual(run.returncode, 0, run.stderr)
            text = (self.folder / "s.inp").read_text()
            nodes = {}
            for line in text.split("*NODE, NSET=NALL\n")[1].split("*")[0].splitlines():
                number, *place = line.split(",")
                nodes[int(number)] = tuple(map(float, place))
            found = elements_of(self.folder / "s.inp")
            self.assertEqual(list(found), [element])
            for corner in found[element]:
                (ax, ay, _), (bx, by, _), (cx, cy, _) = (nodes[n] for n in corner[:3])
                self.assertGreater((bx - ax) * (cy - ay) - (by - ay) * (cx - ax), 0)
                if order == 2:
                    for i, j, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
                        self.assertAlmostEqual(nodes[corner[middle]][0],
                                               (nodes[corner[i]][0] + nodes[corner[j]][0]) / 2)
                        self.assertAlmostEqual(nodes[corner[middle]][1],
                                               (nodes[corner[i]][1] + nodes[corner[j]][1]) / 2)
        run = self.run_program(self.box, "-o", "b.inp", "--dimension", "2", "--triangle-elements", "plane-stress")
        self.assertNotEqual(run.returncode, 0)
        self.assertRegex(run.stderr, "plane z = 0")
        self.assertRegex(run.stderr, COORDINATES)
        self.expect(2, self.box, "-o", self.out, "--dimension", "2",
                    "--triangle-elements", "plane-stress", says=["use .inp"])

    def test_lines_of_a_wire(self):
        wire = self.write("wire.poly", WIRE)
        for name in ("w.vtu", "w.vtk", "w.msh", "w.msh2", "w.mesh", "w.unv", "w.inp"):
            for order in ("1", "2"):
                run = self.run_program(wire, "-o", name, "--dimension", "1", "--size",
                                       "2", "--order", order, "--report", "r.json")
                self.assertEqual(run.returncode, 0, name + run.stderr)
                self.assertIn("every guarantee holds", run.stderr)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual([round(each["mesh"], 9) for each in report["check"]["kept"]["curve_lengths"]], [10, 10, 5])
        found = elements_of(self.folder / "w.inp")
        self.assertEqual({kind: len(each) for kind, each in found.items()}, {"B32": 5 + 5 + 3})
        text = (self.folder / "w.inp").read_text()
        for tag in (7, 8, 9):
            self.assertIn(f"TYPE=B32, ELSET=CURVE_{tag}", text)
        run = self.run_program(wire, "-o", "w.inp", "--dimension", "1", "--size", "2", "--curve-size", "7=0.5")
        self.assertGreaterEqual(len(elements_of(self.folder / "w.inp")["B31"]), 20 + 5 + 3)
        run = self.run_program("check", "w.vtu", "--against", wire)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        other = self.write("other.poly", WIRE.replace("4 10 10 5 0", "4 10 10 6 0"))
        self.assertEqual(self.run_program("check", "w.vtu", "--against", other).returncode, 7)
        self.expect(2, wire, "-o", "w.stl", "--dimension", "1", says=["no place for lines alone|with no place"])

    def test_wrong_lines_are_found(self):
        """Checks the certificate of lines for a file that was changed."""
        wire = self.write("wire.poly", WIRE)
        self.run_program(wire, "-o", "w.mesh", "--dimension", "1", "--size", "2")
        lines = (self.folder / "w.mesh").read_text().splitlines()
        points, edges = lines.index("Vertices"), lines.index("Edges")
        inner = next(i for i in range(points + 2, points + 2 +
                     int(lines[points + 1])) if lines[i].split()[0] not in ("0", "10"))
        x, y, z, *rest = lines[inner].split()

        def changed(at, text):
            return lines[:at] + [text] + lines[at + 1:]

        count = int(lines[edges + 1])
        first, second, third = (lines[edges + 2 + i].split() for i in range(3))
        cases = {"curve_cover|curve_distance": changed(inner, " ".join([x, y, f"{float(z) + 1}", *rest])),
                 "curve_cover": changed(edges + 1, str(count - 1))[:edges + 2] + lines[edges + 3:],
                 "curve_tag": changed(edges + 2, " ".join([*first[:2], "77"])),
                 "listed_edges|curve_cover": changed(edges + 2, " ".join([*second[:2], first[2]])),
                 "referenced_points": changed(edges + 2, " ".join([*third[:2], first[2]]))}
        for finding, text in cases.items():
            bad = self.write("bad.mesh", "\n".join(text) + "\n")
            run = self.run_program("check", bad, "--against", wire)
            self.assertEqual(run.returncode, 7, finding + run.stdout + run.stderr)
            self.assertRegex(run.stdout, finding)

    def test_lines_that_cross_share_a_node(self):
        cross = self.write(
            "cross.poly", "4 3 0 0\n1 0 0 0\n2 9 9 0\n3 9 0 0\n4 0 9 0\n2 1\n1 0 1\n2 1 2\n1 0 2\n2 3 4\n0\n0\n")
        self.expect(0, cross, "-o", self.out, "--dimension", "1", "--size", "2",
                    says=[r"cut, the first at \(4.5, 4.5, 0\)"], writes=True)
        self.run_program(cross, "-o", "w.inp", "--dimension", "1", "--size", "2")
        ends = [n for edge in elements_of(self.folder / "w.inp")["B31"] for n in edge]
        self.assertEqual(sorted(ends.count(n) for n in set(ends))[-1], 4)

    def test_lines_of_a_surface(self):
        self.expect(0, self.box, "-o", self.out, "--dimension", "1", "--size", "0.25", says=["48 lines"], writes=True)

    def test_converted(self):
        self.run_program(self.open, "-o", "a.unv", "--size", "0.3", "--dimension", "2", "--order", "2")
        run = self.run_program("convert", "a.unv", "-o", "a.inp")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("S6", elements_of(self.folder / "a.inp"))
        self.assertEqual(self.run_program("info", "a.unv").returncode, 0)
        run = self.run_program("remesh", "a.unv", "-o", self.out)
        self.assertNotEqual(run.returncode, 0)
        self.assertRegex(run.stderr, "tetrahedra")

    def test_surfaces_that_intersect_are_cut(self):
        cross = off_text(SQUARE + [(1, -0.5, -1), (1, 2.5, -1), (1, 2.5, 1),
                         (1, -0.5, 1)], [(0, 1, 2, 3), (4, 5, 6, 7)])
        inside = off_text(SQUARE + [(1, 1, -1), (1, 1, 1), (3, 1, 0)], [(0, 1, 2, 3), (4, 5, 6)])
        standing = off_text(SQUARE + [(0.5, 1, 0), (1.5, 1, 0), (1.5, 1, 1), (0.5, 1, 1)], [(0, 1, 2, 3), (4, 5, 6, 7)])
        over = off_text(SQUARE + [(1, 1, 0), (3, 1, 0), (3, 3, 0), (1, 3, 0)], [(0, 1, 2, 3), (4, 5, 6, 7)])
        for text, area in ((cross, 4 + 6), (inside, 4 + 2), (standing, 4 + 1), (over, 4 + 4 - 1)):
            surface = self.write("surface.off", text)
            run = self.run_program(surface, "-o", self.out, "--dimension", "2", "--size", "0.4", "--report", "r.json")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertRegex(run.stderr, r"intersecting facets? cut, the first at \(")
            kept = json.loads((self.folder / "r.json").read_text())["check"]["kept"]["patch_areas"]
            self.assertAlmostEqual(sum(each["mesh"] for each in kept), area, 6)
            self.out.unlink()
            self.expect(4, surface, "-o", self.out, "--dimension", "2",
                        "--repair", "none", says=["intersect|touch", COORDINATES])

    def test_faces_without_area_and_wires(self):
        line = self.write("line.off", off_text([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]))
        run = self.expect(4, line, "-o", self.out, "--dimension", "2", says=["no facet with an area"])
        self.assertNotIn("--dimension 2", run.stderr)
        some = self.write("some.off", off_text(SQUARE + [(1, 0, 0), (4, 0, 0)], [(0, 1, 2, 3), (0, 4, 1), (1, 4, 5)]))
        self.expect(0, some, "-o", self.out, "--dimension", "2", says=["2 triangles without an area"], writes=True)
        self.out.unlink()
        wire = self.write("wire.poly", WIRE)
        self.expect(4, wire, "-o", self.out, "--dimension", "2",
                    says=["no faces to mesh with triangles", "--dimension 1"])
        self.expect(4, line, "-o", self.out, "--dimension", "1", says=["no"])
        self.expect(4, wire, "-o", self.out, says=["has lines", COORDINATES, "--dimension 1"])

    def test_the_same_bytes(self):
        written = []
        for threads in (1, 2):
            self.expect(0, self.box, "-o", self.out, "--size", "0.1", "--dimension", "2", "--threads", threads,
                        writes=True)
            written.append(self.out.read_bytes())
        self.assertEqual(written[0], written[1])


if __name__ == "__main__":
    unittest.main()
