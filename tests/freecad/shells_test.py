"""Faces, open surfaces and wires, meshed with triangles and lines: from the shape to CalculiX's displacements, with
FEM's thicknesses and beam sections. Run by run.py."""

import math
import os
import sys
import unittest

import FreeCAD
import ObjectsFem
import Part
from FreeCAD import Vector
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import elements, mesh_object, open_shape
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402
from analysis import Analysis  # noqa: E402

YOUNG = 210000


def groups(fem_mesh):
    return {fem_mesh.getGroupName(n): set(fem_mesh.getGroupElements(n)) for n in fem_mesh.Groups}


def angle_sheet():
    """An L of sheet metal, as the middle surface of two flanges."""
    upright, foot = Part.makePlane(40, 60), Part.makePlane(40, 30)
    upright.rotate(Vector(0, 0, 0), Vector(1, 0, 0), 90)
    return Part.makeShell([upright, foot])


def gutter():
    """A half of a pipe."""
    return Part.makeCylinder(20, 100, Vector(0, 0, 0), Vector(0, 0, 1), 180).Faces[0]


def profile(offset):
    """Returns two legs with a bend between them, at a distance from their inner side: foot, bend, upright."""
    inner, radius = 4, 4 + offset  # radii of the bend
    centre, slant = Vector(0, 0, 0), radius * math.sqrt(0.5)
    bend = Part.Arc(centre + Vector(0, 0, -radius), centre + Vector(0, -
                    slant, -slant), centre + Vector(0, -radius, 0)).toShape()
    return [Part.makeLine(Vector(0, 60 - inner, -radius), Vector(0, 0, -radius)), bend,
            Part.makeLine(Vector(0, -radius, 0), Vector(0, -radius, 60 - inner))]


def bracket(thickness):
    """A bracket of sheet metal, 40 mm wide, bent, with a hole in each leg: its middle surface, and the solid."""
    width = Vector(40, 0, 0)
    middle = Part.makeShell([edge.extrude(width) for edge in profile(thickness / 2)])
    inner, outer = profile(0), profile(thickness)
    ends = [Part.makeLine(inner[i].Vertexes[j].Point, outer[i].Vertexes[j].Point) for i, j in ((0, 0), (2, 1))]
    solid = Part.Face(Part.Wire(Part.__sortEdges__([*inner, *outer, *ends]))).extrude(width)
    holes = [Part.makeCylinder(6, 20, Vector(20, 30, -15)), Part.makeCylinder(6,
                                                                              20, Vector(20, -15, 30), Vector(0, 1, 0))]
    for hole in holes:
        middle, solid = middle.cut(hole), solid.cut(hole)
    return middle, solid


class Decisions(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def add(self, shape):
        part = self.document.addObject("Part::Feature", "Part")
        part.Shape = shape
        return part

    def test_the_dimension_is_that_of_the_shape(self):
        box = Part.makeBox(10, 10, 10)
        for shape, expected in ((box, 3), (Part.makeShell(box.Faces), 3), (Part.makeSphere(5).Faces[0], 3),
                                (box.Faces[0], 2), (Part.makeShell(box.Faces[:5]), 2), (angle_sheet(), 2),
                                (Part.Wire(box.Faces[0].Edges), 1)):
            part = self.add(shape)
            self.assertEqual(open_shape.dimension(part, 0, False), expected)
            self.assertEqual(elements.dimension(collarmesh_workbench.mesh(part, size=5).FemMesh), expected)
        self.assertEqual(open_shape.dimension(self.add(Part.makeShell(box.Faces[:5])), 0, True), 3)

    def test_what_is_chosen_is_told(self):
        obj = mesh_object.make(self.document, self.add(Part.makePlane(10, 10)))
        self.assertEqual(obj.ElementDimension, "From Shape")
        notes = mesh_object.remesh(obj)["notes"]
        self.assertIn("Part encloses no volume: it is meshed with triangles, for shells.", notes)
        obj.ElementDimension = "2D"
        self.assertFalse([each for each in mesh_object.remesh(obj)["notes"] if "encloses" in each])

    def test_faces_of_a_solid(self):
        obj = collarmesh_workbench.mesh(self.add(Part.makeBox(10, 10, 10)), size=3, dimension=2)
        self.assertEqual(obj.ElementDimension, "2D")
        self.assertEqual({name for name in groups(obj.FemMesh) if name.startswith("Face")},
                         {f"Face{i}" for i in range(1, 7)})

    def test_what_is_wrong_names_the_field(self):
        for shape, dimension, words in ((Part.makePlane(10, 10), 3, "2D in “Dimension of the elements”"),
                                        (Part.makeLine((0, 0, 0), (1, 0, 0)), 3, "1D in “Dimension of the elements”"),
                                        (Part.makeLine((0, 0, 0), (1, 0, 0)), 2, "1D in “Dimension of the elements”"),
                                        (Part.Vertex(1, 2, 3), 1, "no edges")):
            with self.assertRaisesRegex(MesherError, words):
                collarmesh_workbench.mesh(self.add(shape), size=1, dimension=dimension)

    def test_lookup_finds_the_nodes_of_the_groups(self):
        for shape in (angle_sheet(), gutter()):
            fem_mesh = collarmesh_workbench.mesh(self.add(shape), size=5).FemMesh
            found = groups(fem_mesh)
            for number, face in enumerate(shape.Faces, 1):
                self.assertEqual(set(fem_mesh.getFacesByFace(face)), found[f"Face{number}"])
            for number, edge in enumerate(shape.Edges, 1):
                nodes = {n for each in found[f"Edge{number}"] for n in fem_mesh.getElementNodes(each)}
                self.assertEqual(set(fem_mesh.getNodesByEdge(edge)), nodes)

    def test_nodes_of_lines_lie_on_curved_edges(self):
        spline = Part.BSplineCurve()
        spline.interpolate([Vector(0, 0, 0), Vector(10, 8, 3), Vector(25, -4, 6), Vector(40, 0, 0)])
        arc = Part.Arc(Vector(40, 0, 0), Vector(47, 7, 0), Vector(40, 14, 0))
        shape = Part.Wire([spline.toShape(), arc.toShape()])
        for order in (1, 2):
            fem_mesh = collarmesh_workbench.mesh(self.add(shape), size=3, order=order).FemMesh
            found = groups(fem_mesh)
            for number, edge in enumerate(shape.Edges, 1):
                nodes = {n for each in found[f"Edge{number}"] for n in fem_mesh.getElementNodes(each)}
                self.assertEqual(set(fem_mesh.getNodesByEdge(edge)), nodes)
                self.assertGreater(len(nodes), edge.Length / 4)
            self.assertEqual(elements.order(fem_mesh), order)


class Thin(unittest.TestCase):
    """Analyses with results."""

    def solve(self, analysis, size, dimension=0):
        analysis.mesh(2, size, dimension=dimension)
        result = analysis.solve()
        analysis.remove_mesh()
        return result

    def plate(self, thicknesses=(2,)):
        length, width, force = 100, 20, 10
        faces = [Part.makePlane(length / len(thicknesses), width, Vector(i * length / len(thicknesses), 0, 0))
                 for i in range(len(thicknesses))]
        analysis = Analysis(faces[0] if len(faces) == 1 else Part.makeShell(faces), poisson_ratio=0)
        for number, thickness in enumerate(thicknesses, 1):
            section = analysis.add(ObjectsFem.makeElementGeometry2D(analysis.document, thickness))
            if len(thicknesses) > 1:
                section.References = [(analysis.part, f"Face{number}")]
        analysis.clamp("Edge", (0, width / 2, 0))
        analysis.pull_at("Edge", (length, width / 2, 0), force, (0, 0, 1))
        return analysis, length, width, force

    def test_a_face_is_a_cantilever(self):
        analysis, length, width, force = self.plate()
        result = self.solve(analysis, 5)
        stiffness = YOUNG * width * 2**3 / 12
        self.assertAlmostEqual(result["displacement"] / (force * length**3 / (3 * stiffness)), 1, delta=0.01)
        self.assertAlmostEqual(abs(result["reactions"][2]) / force, 1, delta=1e-3)
        analysis.close()

    def test_faces_with_thicknesses_of_their_own(self):
        analysis, length, width, force = self.plate((4, 2))
        result = self.solve(analysis, 4)
        first, second = (YOUNG * width * t**3 / 12 for t in (4, 2))
        half = length / 2
        known = force * (half**3 / (3 * second) + (length**3 - half**3) / (3 * first))
        self.assertAlmostEqual(result["displacement"] / known, 1, delta=0.015)
        analysis.close()

    def compare(self, shape, held, pulled, size, direction, axis, force=20):
        """Compares with the same analysis on Gmsh's mesh."""
        analysis = Analysis(shape)
        analysis.add(ObjectsFem.makeElementGeometry2D(analysis.document, 2))
        analysis.clamp("Edge", held)
        analysis.pull_at("Edge", pulled, force, direction)
        ours = self.solve(analysis, size)
        analysis.mesh_by_gmsh(2, size)
        gmsh = analysis.solve()
        print(f"displacement {ours['displacement']:.6g} mm, on Gmsh's mesh {gmsh['displacement']:.6g} mm", flush=True)
        self.assertAlmostEqual(ours["displacement"] / gmsh["displacement"], 1, delta=0.01)
        self.assertAlmostEqual(abs(ours["reactions"][axis]) / force, 1, delta=1e-3)
        analysis.close()

    def test_an_open_shell(self):
        self.compare(gutter(), (0, 20, 0), (0, 20, 100), 5, (1, 0, 0), 0)

    def test_bent_sheet(self):
        self.compare(angle_sheet(), (20, 30, 0), (20, 0, 60), 4, (0, 1, 0), 1)

    def test_bracket_as_shell_and_as_solid(self):
        thickness, force = 2, 30
        displacements = []
        for shape, kind in zip(bracket(thickness), ("Edge", "Face")):
            analysis = Analysis(shape)
            if kind == "Edge":
                analysis.add(ObjectsFem.makeElementGeometry2D(analysis.document, thickness))
            middle = 4 + thickness / 2
            analysis.clamp(kind, (20, 56, -middle))
            analysis.pull_at(kind, (20, -middle, 56), force, (0, 1, 0))
            displacements.append(self.solve(analysis, 3)["displacement"])
            analysis.close()
        print(f"bracket as shell {displacements[0]:.6g} mm, as solid {displacements[1]:.6g} mm", flush=True)
        self.assertAlmostEqual(displacements[0] / displacements[1], 1, delta=0.05)

    def test_a_wire_is_beams(self):
        """Two straight parts in line, with a transverse force at the end."""
        length, side, force = 200, 10, 100
        points = [Vector(0, 0, 0), Vector(length / 4, 0, 0), Vector(length, 0, 0)]
        analysis = Analysis(Part.makePolygon(points), poisson_ratio=0)
        analysis.add(ObjectsFem.makeElementGeometry1D(analysis.document, "Rectangular", side, side))
        analysis.clamp("Vertex", (0, 0, 0))
        analysis.pull_at("Vertex", (length, 0, 0), force, (0, 0, 1))
        known = force * length**3 / (3 * YOUNG * side**4 / 12)
        result = self.solve(analysis, 20)
        self.assertAlmostEqual(result["displacement"] / known, 1, delta=0.01)
        analysis.close()


run_in_freecad.run(Decisions, Thin)
