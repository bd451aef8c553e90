"""The requested sizes that are shown as colours: compared with formulas and with the edges of a mesh. Run by
run.py."""

import os
import sys
import unittest

import FreeCAD
import numpy
import Part
from freecad.collarmesh_workbench import asked_sizes, mesh_object, mesh_properties, size_objects

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


class AskedSizes(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.part = self.document.addObject("Part::Feature", "Part")
        self.part.Shape = Part.makeBox(20, 12, 8)
        self.obj = mesh_object.make(self.document, self.part)
        self.obj.CharacteristicLengthMax = 4

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def asked(self):
        """Returns the surface and the sizes on it."""
        surface = asked_sizes.surface_of(self.part)
        return surface, asked_sizes.on(surface, self.part, mesh_properties.settings_of(self.obj))

    def test_triangles_cover_the_part(self):
        surface = asked_sizes.surface_of(self.part)
        a, b, c = numpy.moveaxis(surface.places.reshape(-1, 3, 3), 1, 0)
        areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
        for number, face in enumerate(self.part.Shape.Faces, 1):
            self.assertAlmostEqual(areas[surface.faces[::3] == number].sum(), face.Area, places=6)
        self.assertLess(numpy.linalg.norm(b - a, axis=1).max(), self.part.Shape.BoundBox.DiagonalLength / 50)

    def test_bodies(self):
        """The distance from each body is the one that OpenCASCADE finds."""
        for kind in ("Sphere", "Box", "Cylinder"):
            size = size_objects.make(self.obj, kind, 0.5)
            size.Placement = FreeCAD.Placement(FreeCAD.Vector(18, 3, 6), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 30))
            size.Growth = 0.4
            size.recompute()
            surface, sizes = self.asked()
            for i in range(0, len(sizes), len(sizes) // 40):
                distance = size.Shape.Solids[0].distToShape(Part.Vertex(*surface.places[i]))[0]
                self.assertAlmostEqual(sizes[i], min(4, 0.5 + 0.4 * distance),
                                       places=5, msg=f"{kind} at {surface.places[i]}")
            self.document.removeObject(size.Name)

    def test_faces_and_edges(self):
        near = size_objects.make(self.obj, "Distance", 0.5)
        near.References = [(self.part, ("Face1",))]
        near.Within = 1
        near.Growth = 0.2
        surface, sizes = self.asked()
        x = surface.places[:, 0]  # Face1 is at x = 0
        self.assertLess(numpy.abs(sizes - numpy.minimum(4, 0.5 + 0.2 * numpy.maximum(0, x - 1))).max(), 0.2)
        near.References = [(self.part, ("Edge1",))]  # along z
        surface, sizes = self.asked()
        away = numpy.hypot(*surface.places[:, :2].T)
        self.assertLess(numpy.abs(sizes - numpy.minimum(4, 0.5 + 0.2 * numpy.maximum(0, away - 1))).max(), 0.2)

    def test_curvature(self):
        self.part.Shape = Part.makeCylinder(3, 20)
        self.obj.MeshSizeFromCurvature = 24
        surface, sizes = self.asked()
        on_side = surface.faces == next(i for i, f in enumerate(self.part.Shape.Faces, 1)
                                        if type(f.Surface).__name__ == "Cylinder")
        self.assertLess(numpy.abs(sizes[on_side] - 2 * numpy.pi * 3 / 24).max(), 1e-6)
        self.assertEqual(sizes[~on_side].min(), 4)

    def test_a_mesh_follows_them(self):
        ball = size_objects.make(self.obj, "Sphere", 0.6)
        ball.Placement.Base = FreeCAD.Vector(20, 12, 8)
        ball.Radius = 3
        mesh_object.remesh(self.obj)
        fem_mesh = self.obj.FemMesh
        surface, sizes = self.asked()
        ratios = []
        for element in fem_mesh.Faces[::10]:
            corners = [fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:3]]
            length = sum((a - b).Length for a, b in zip(corners, corners[1:] + corners[:1])) / 3
            middle = numpy.mean([tuple(p) for p in corners], axis=0)
            ratios.append(length / sizes[numpy.linalg.norm(surface.places - middle, axis=1).argmin()])
        self.assertLess(abs(numpy.log(numpy.median(ratios))), numpy.log(1.5))
        self.assertLess(numpy.mean(numpy.abs(numpy.log(ratios)) > numpy.log(2.5)), 0.1)

    def test_triangle_meshes(self):
        import Mesh

        self.part = self.document.addObject("Mesh::Feature", "Triangles")
        self.part.Mesh = Mesh.createBox(4, 4, 4)
        obj = mesh_object.make(self.document, self.part)
        sizes = asked_sizes.on(asked_sizes.surface_of(self.part), self.part, mesh_properties.settings_of(obj))
        self.assertTrue(len(sizes) > 1000 and numpy.allclose(sizes, 4 * 3**0.5 / 20))


run_in_freecad.run(AskedSizes)
