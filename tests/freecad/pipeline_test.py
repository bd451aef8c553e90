"""From shape to stresses, without the GUI: FEM's constraints find the nodes, CalculiX's reactions balance the loads,
and displacement and stress are those of the same analysis on Gmsh's mesh. Run by run.py."""

import dataclasses
import math
import os
import sys
import unittest

import FreeCAD
import Part
from BOPTools import SplitAPI
from FreeCAD import Vector
from freecad import collarmesh_workbench

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402
from analysis import Analysis  # noqa: E402

DISPLACEMENT_TOLERANCE = 0.02
STRESS_TOLERANCE = 0.02
PEAK_RADIUS = 0.3  # mm, a tenth of the smallest hole's radius
REACTION_TOLERANCE = 0.005  # because triangles replace curved faces
# relative to Gmsh's size: with a size on one face, our mesher makes two thirds of its nodes at the same size
OUR_SIZE = 0.85
ORDERS = [int(order) for order in os.environ.get("COLLARMESH_TEST_ORDERS", "1,2").split(",")]


@dataclasses.dataclass
class Case:
    """An analysis without a mesh, and its expected reactions (N, by axis; None: unspecified)."""

    analysis: Analysis
    reactions: tuple
    size: float  # size for elements of first order; twice as large for second order
    fine_size: float  # size on the face with the largest stress, small enough for both orders to have converged there
    critical: tuple  # a place on that face


def plate_with_hole():
    """A quarter of a plate with a hole: pulled, with pressure in the hole."""
    radius, thickness, pressure, force = 5, 3, 20, 4500
    plate = Part.makeBox(20, 15, thickness).cut(Part.makeCylinder(radius, thickness))
    analysis = Analysis(plate)
    analysis.hold("x", (0, 10, 1.5))
    analysis.hold("y", (12, 0, 1.5))
    analysis.hold("z", (12, 8, 0))
    analysis.pull((20, 7, 1.5), force, (1, 0, 0))
    analysis.press((radius * math.sqrt(0.5), radius * math.sqrt(0.5), 1.5), pressure)
    in_hole = pressure * radius * thickness
    return Case(analysis, (-force - in_hole, -in_hole, 0), 1.1, 0.2, (3, 4, 1.5))


def filleted_bracket():
    """An L-shaped bracket with a fillet in its corner, bent: held where the curved fillet's leg ends, with
    pressure on the fillet."""
    radius, thickness, pressure, force = 5, 3, 4, 150
    corners = [Vector(*p) for p in ((0, 0, 0), (30, 0, 0), (30, 8, 0), (8, 8, 0), (8, 30, 0), (0, 30, 0), (0, 0, 0))]
    bracket = Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 0, thickness))
    inner = [e for e in bracket.Edges if all(abs(v.X - 8) + abs(v.Y - 8) < 1e-9 for v in e.Vertexes)]
    analysis = Analysis(bracket.makeFillet(radius, inner), poisson_ratio=0)  # so that a held face has no singular edges
    analysis.hold("xyz", (30, 4, thickness / 2))
    analysis.pull((4, 30, thickness / 2), force, (1, 0, 0))
    centre, off = 8 + radius, radius * math.sqrt(0.5)
    analysis.press((centre - off, centre - off, thickness / 2), pressure)
    on_fillet = pressure * radius * thickness
    return Case(analysis, (-force + on_fillet, on_fillet, 0), 1.1, 0.27, (centre - off, centre - off, thickness / 2))


def acute_wedge():
    """A wedge of 40 degrees with a hole: pulled along its edge, with pressure in the hole."""
    length, width, pressure, force = 20, 2, 60, 2000
    height = length * math.tan(math.radians(40))
    corners = [Vector(0, 0, 0), Vector(length, 0, 0), Vector(length, height, 0), Vector(0, 0, 0)]
    wedge = Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 0, width))
    hole, radius = Vector(13, 5, 0), 3
    analysis = Analysis(wedge.cut(Part.makeCylinder(radius, width, hole)))
    analysis.hold("x", (length, height / 2, width / 2))
    analysis.hold("y", (length / 2, 0, width / 2))
    analysis.hold("z", (18, 2, 0))
    analysis.pull((18, 2, width), force, (0, 0, 1))
    analysis.press((hole.x + radius, hole.y, width / 2), pressure)
    return Case(analysis, (0, 0, -force), 0.8, 0.2, (hole.x + radius, hole.y, width / 2))


def two_solids():
    """A plate with a stiffer disc in it, in plane strain: pulled."""
    thickness, force = 1, 1500
    hole = Part.makeCylinder(5, thickness)
    box = Part.makeBox(20, 15, thickness)
    parts = SplitAPI.booleanFragments([box.cut(hole), box.common(hole)], "CompSolid")
    analysis = Analysis(parts, youngs_moduli=(70000, 210000))
    analysis.hold("x", (0, 10, thickness / 2), (0, 3, thickness / 2))
    analysis.hold("y", (12, 0, thickness / 2), (3, 0, thickness / 2))
    analysis.hold("z", (12, 8, 0), (2, 2, 0), (12, 8, thickness), (2, 2, thickness))
    analysis.pull((20, 7, thickness / 2), force, (1, 0, 0))
    return Case(analysis, (-force, 0, None), 1.1, 0.3, (3, 4, thickness / 2))


class Pipeline(unittest.TestCase):
    def compare(self, make):
        case = make()
        analysis = case.analysis
        load = sum(abs(reaction or 0) for reaction in case.reactions)
        try:
            results = {order: self.solve_both(case, order, load) for order in ORDERS}
            print(f"{make.__name__}: {results}", flush=True)
            for order, (ours, gmsh) in results.items():
                for quantity, tolerance in (("displacement", DISPLACEMENT_TOLERANCE), ("stress", STRESS_TOLERANCE)):
                    with self.subTest(order=order, quantity=quantity):
                        self.assertLess(abs(ours[quantity] / gmsh[quantity] - 1), tolerance)
        finally:
            analysis.close()

    def solve_both(self, case, order, load):
        """Solves with our mesh and with Gmsh's."""
        analysis = case.analysis
        size, fine_size = case.size * order, case.fine_size
        analysis.mesh(order, OUR_SIZE * size, OUR_SIZE * fine_size, case.critical)
        ours = analysis.solve(PEAK_RADIUS)
        self.look_up(analysis)
        analysis.remove_mesh()
        for found, expected in zip(ours["reactions"], case.reactions):
            if expected is not None:
                self.assertLess(abs(found - expected), REACTION_TOLERANCE * load)
        analysis.mesh_by_gmsh(order, size, fine_size, case.critical)
        gmsh = analysis.solve(PEAK_RADIUS)
        analysis.remove_mesh()
        return ours, gmsh

    def look_up(self, analysis):
        """FEM's look-up finds exactly the elements of the groups of the faces."""
        fem_mesh = analysis.mesh_object.FemMesh
        shape = analysis.part.Shape
        groups = {fem_mesh.getGroupName(number): fem_mesh.getGroupElements(number) for number in fem_mesh.Groups}
        for number, face in enumerate(shape.Faces, 1):
            elements = groups.get(f"Face{number}")
            if elements is None:  # it coincides with a face of another solid, whose number the mesh has
                self.assertGreater(len(shape.Solids), 1)
                continue
            nodes = {node for element in elements for node in fem_mesh.getElementNodes(element)}
            self.assertEqual(set(fem_mesh.getNodesByFace(face)), nodes, f"Face{number}")
            self.assertEqual(set(fem_mesh.getFacesByFace(face)), set(elements), f"Face{number}")
        if len(shape.Solids) > 1:
            of_materials = [elements for name, elements in groups.items() if name.startswith("Material")]
            self.assertEqual(len(of_materials), len(shape.Solids))
            self.assertEqual(sum(map(len, of_materials)), fem_mesh.VolumeCount)

    def test_plate_with_hole(self):
        self.compare(plate_with_hole)

    def test_filleted_bracket(self):
        self.compare(filleted_bracket)

    def test_acute_wedge(self):
        self.compare(acute_wedge)

    def test_two_solids(self):
        self.compare(two_solids)

    def test_first_order_is_too_stiff(self):
        """Checks the panel's claim that first order is too stiff for bending, on a cantilever meshed with the
        default size."""
        length, width, height, force = 60, 10, 4, 100
        expected = force * length**3 / (3 * 210000 * width * height**3 / 12)  # mm
        analysis = Analysis(Part.makeBox(length, width, height))
        analysis.hold("xyz", (0, 5, 2))
        analysis.pull((length, 5, 2), force, (0, 0, 1))
        found = {}
        for order in (1, 2):
            analysis.mesh(order, analysis.part.Shape.BoundBox.DiagonalLength / 20)
            found[order] = analysis.solve()["displacement"] / expected
            analysis.remove_mesh()
        analysis.close()
        self.assertAlmostEqual(found[2], 1, delta=0.03)
        self.assertLess(found[1], 0.8)
        new = collarmesh_workbench.mesh(Part.makeBox(1, 1, 1))
        self.assertEqual(new.ElementOrder, "2nd")
        FreeCAD.closeDocument(new.Document.Name)


run_in_freecad.run(Pipeline)
