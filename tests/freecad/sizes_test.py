"""Sizes as objects of the document reach the program, and the mesh has them. Run by run.py."""

import os
import sys
import tempfile
import unittest

import FreeCAD
import numpy
import Part
from freecad.collarmesh_workbench import mesh_object, size_objects
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402

SIZE, COARSE = 0.8, 5
TOLERANCE = 0.15  # tolerance of the median edge length, relative to the requested size


def edges_of(fem_mesh):
    """Returns the ends of all edges, shape (n, 2, 3), mm."""
    nodes = {number: tuple(place) for number, place in fem_mesh.Nodes.items()}
    pairs = set()
    for element in fem_mesh.Volumes:
        corners = fem_mesh.getElementNodes(element)[:4]
        pairs.update(tuple(sorted((a, b))) for i, a in enumerate(corners) for b in corners[:i])
    return numpy.array([[nodes[a], nodes[b]] for a, b in pairs])


def median_length(edges):
    return numpy.median(numpy.linalg.norm(edges[:, 1] - edges[:, 0], axis=1))


class Sizes(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.part = self.document.addObject("Part::Feature", "Block")
        self.part.Shape = Part.makeBox(40, 30, 20)
        self.obj = mesh_object.make(self.document, self.part)
        self.obj.CharacteristicLengthMax = COARSE

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def require_size(self, inside, far):
        """Checks that the mesh has the size where `inside(points)` is true, and is coarse where `far` is."""
        mesh_object.remesh(self.obj)
        edges = edges_of(self.obj.FemMesh)
        both = inside(edges[:, 0]) & inside(edges[:, 1])
        self.assertGreater(both.sum(), 200)
        self.assertLess(abs(median_length(edges[both]) / SIZE - 1), TOLERANCE)
        beyond = far(edges[:, 0]) & far(edges[:, 1])
        self.assertGreater(beyond.sum(), 20)
        self.assertGreater(median_length(edges[beyond]), 0.6 * COARSE)

    def test_sphere(self):
        size = size_objects.make(self.obj, "Sphere", SIZE)
        size.Radius = 4
        size.Placement.Base = FreeCAD.Vector(8, 8, 8)
        self.assertEqual(self.obj.MeshSizeList, [size])

        def distance(p):
            return numpy.linalg.norm(p - (8, 8, 8), axis=1)

        self.require_size(lambda p: distance(p) < 4, lambda p: distance(p) > 20)

    def test_box_along_the_axes_and_turned(self):
        size = size_objects.make(self.obj, "Box", SIZE)
        size.Length, size.Width, size.Height = 12, 4, 4
        size.Placement.Base = FreeCAD.Vector(4, 10, 10)

        def inside(p):
            return ((p > (4, 10, 10)) & (p < (16, 14, 14))).all(axis=1)

        self.require_size(inside, lambda p: p[:, 0] > 34)
        turn = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 45)
        size.Placement.Rotation = turn
        back = numpy.array(turn.inverted().toMatrix().A).reshape(4, 4)[:3, :3]
        self.require_size(lambda p: inside((p - (4, 10, 10)) @ back.T + (4, 10, 10)), lambda p: p[:, 0] > 34)

    def test_cylinder_across(self):
        size = size_objects.make(self.obj, "Cylinder", SIZE)
        size.Radius, size.Height = 3, 20
        size.Placement = FreeCAD.Placement(
            FreeCAD.Vector(8, 5, 10), FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), -90)
        )
        self.require_size(
            lambda p: (numpy.hypot(p[:, 0] - 8, p[:, 2] - 10) < 3) & (p[:, 1] > 5) & (p[:, 1] < 25),
            lambda p: p[:, 0] > 32,
        )

    def test_distance_from_faces_and_edges(self):
        """The program's numbers of faces and edges are FreeCAD's."""
        for number, face in enumerate(self.part.Shape.Faces, 1):
            if face.CenterOfMass.x < 1e-6:
                left = f"Face{number}"
        size = size_objects.make(self.obj, "Distance", SIZE)
        size.References = [(self.part, (left,))]
        size.Within = 2
        self.require_size(lambda p: p[:, 0] < 2, lambda p: p[:, 0] > 25)
        for number, edge in enumerate(self.part.Shape.Edges, 1):
            middle = edge.valueAt((edge.FirstParameter + edge.LastParameter) / 2)
            if middle.isEqual(FreeCAD.Vector(40, 30, 10), 1e-6):
                right = f"Edge{number}"
        size.References = [(self.part, (right,))]

        def distance(p):
            return numpy.hypot(p[:, 0] - 40, p[:, 1] - 30)

        self.require_size(lambda p: distance(p) < 2, lambda p: distance(p) > 25)
        size.References = [(self.part, (left, right))]
        self.require_size(
            lambda p: (p[:, 0] < 2) | (distance(p) < 2), lambda p: (distance(p) > 18) & (p[:, 0] > 18)
        )

    def test_growth(self):
        size = size_objects.make(self.obj, "Sphere", SIZE)
        counts = []
        for growth in (0.1, 0.3, 1):
            size.Growth = growth
            mesh_object.remesh(self.obj)
            counts.append(self.obj.FemMesh.VolumeCount)
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertGreater(counts[0], 1.5 * counts[2])

    def test_new_ones_are_in_the_part(self):
        for kind in ("Sphere", "Box", "Cylinder"):
            bounds = size_objects.make(self.obj, kind).Shape.BoundBox
            self.assertLess(bounds.Center.distanceToPoint(FreeCAD.Vector(20, 15, 10)), 1e-6, kind)
            self.assertGreater(bounds.DiagonalLength, 5)
        self.assertEqual([each.Size.Value for each in self.obj.MeshSizeList], [COARSE / 4] * 3)

    def test_what_is_wrong_is_told(self):
        other = self.document.addObject("Part::Feature", "Other")
        other.Shape = Part.makeCylinder(3, 5)
        size = size_objects.make(self.obj, "Distance", SIZE)

        def told():
            with self.assertRaises(MesherError) as raised:
                mesh_object.remesh(self.obj)
            return str(raised.exception)

        self.assertIn("SizeDistance has no faces and edges", told())
        size.References = [(other, ("Face1",))]
        self.assertIn("refers to Other, but Block is meshed", told())
        size.References = [(self.part, ("Face1",))]
        self.part.Shape = other.Shape
        seam = next(i for i, e in enumerate(other.Shape.Edges, 1) if isinstance(e.Curve, Part.Line))
        size.References = [(self.part, (f"Edge{seam}",))]
        self.assertIn(f"Edge{seam} is the seam", told())
        size.References = [(self.part, ("Face3",))]
        size.Size = 0
        self.assertIn("Size is 0", told())
        self.document.removeObject(size.Name)
        mesh_object.remesh(self.obj)
        self.assertGreater(self.obj.FemMesh.VolumeCount, 0)

    def test_what_the_program_finds_wrong_is_told_with_the_object(self):
        self.part.Shape = Part.Compound([Part.makeBox(10, 10, 10), Part.makeBox(2, 2, 2, FreeCAD.Vector(4, 4, 4))])
        size_objects.make(self.obj, "Sphere", SIZE)
        size = size_objects.make(self.obj, "Distance", SIZE)
        size.References = [(self.part, ("Face8",))]  # a face of the inner box
        mesh_object.remesh(self.obj)
        said = "sizes.json: size field: sources[1].patches: no patches have the tag 8"
        self.assertIn("SizeDistance: the mesh has nothing of Face8",
                      size_objects.with_labels(said, ["A", "SizeDistance"]))
        said = "sizes.json: size field: sources[1].box: 'min' exceeds 'max'"
        self.assertEqual(size_objects.with_labels(said, ["A", "B"]), "B.box: 'min' exceeds 'max'")
        self.assertEqual(size_objects.with_labels("something else", []), "something else")

    def test_save_and_reopen(self):
        size = size_objects.make(self.obj, "Cylinder", SIZE)
        size.Radius, size.Growth = 3, 0.2
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sizes.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
        self.obj = self.document.getObject("FEMMeshCollarmesh")
        (size,) = self.obj.MeshSizeList
        self.assertEqual((size.Radius.Value, size.Growth, size.Size.Value), (3, 0.2, SIZE))
        self.assertEqual(size_objects.kind_of(size), "Cylinder")
        mesh_object.remesh(self.obj)


run_in_freecad.run(Sizes)
