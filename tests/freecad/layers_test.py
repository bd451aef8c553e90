"""Boundary layers as objects of the document reach the program, and the mesh has them. Run by run.py."""

import math
import os
import shutil
import sys
import tempfile
import unittest

import FreeCAD
import numpy
import ObjectsFem
import Part
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import (elements, groups, guarantees, layer_objects, mesh_object, places, program,
                                          take_over, up_to_date, worst_elements)
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402
from analysis import Analysis  # noqa: E402

TETS, PRISMS = (4, 10), (6, 15)


def number_of(fem_mesh, nodes):
    """Returns the number of volumes with one of these numbers of nodes."""
    return sum(len(fem_mesh.getElementNodes(each)) in nodes for each in fem_mesh.Volumes)


def prisms_on(fem_mesh, name):
    """Returns the prisms of linear layers with a triangle of this group: corners, shape (n, 6, 3), those of
    the triangle first."""
    group = fem_mesh.getGroupElements(groups.named(fem_mesh)[name])
    triangles = {frozenset(fem_mesh.getElementNodes(each)[:3]) for each in group}
    nodes, found = fem_mesh.Nodes, []
    for each in fem_mesh.Volumes:
        corners = fem_mesh.getElementNodes(each)
        for base, top in ((corners[:3], corners[3:6]), (corners[3:6], corners[:3])):
            if len(corners) == 6 and frozenset(base) in triangles:
                found.append([tuple(nodes[n]) for n in (*base, *top)])
    return numpy.array(found).reshape(-1, 6, 3)


def wedge(angle):
    """Returns a wedge with faces of 40 mm that meet at this angle, in degrees."""
    end = FreeCAD.Vector(40 * math.cos(math.radians(angle)), 40 * math.sin(math.radians(angle)), 0)
    corners = [FreeCAD.Vector(), FreeCAD.Vector(40, 0, 0), end, FreeCAD.Vector()]
    return Part.Face(Part.makePolygon(corners)).extrude(FreeCAD.Vector(0, 0, 20))


class Layers(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.part = self.document.addObject("Part::Feature", "Block")
        self.part.Shape = Part.makeBox(20, 10, 10)
        self.obj = mesh_object.make(self.document, self.part)
        self.obj.CharacteristicLengthMax = 3
        self.obj.ElementOrder = "1st"

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def on(self, *names):
        """Makes layers on faces and returns their object."""
        return collarmesh_workbench.add_layers(self.obj, *names)

    def told(self):
        with self.assertRaises(MesherError) as raised:
            mesh_object.remesh(self.obj)
        return str(raised.exception)

    def test_prisms_on_the_faces_alone_with_the_heights_asked(self):
        layers = self.on("Face1", "Face5")
        layers.FirstHeight, layers.Growth, layers.Count = 0.1, 1.5, 4
        report = mesh_object.remesh(self.obj)
        self.assertEqual({each["name"] for each in report["layers"]["patches"]}, {"Face1", "Face5"})
        self.assertTrue(report["guarantees_hold"])
        for name in ("Face1", "Face5"):
            prisms = prisms_on(self.obj.FemMesh, name)
            area = 0.5 * numpy.linalg.norm(numpy.cross(prisms[:, 1] -
                                           prisms[:, 0], prisms[:, 2] - prisms[:, 0]), axis=1).sum()
            self.assertAlmostEqual(area, self.part.Shape.getElement(name).Area, places=6)
            face = self.part.Shape.getElement(name)
            normal = numpy.array(face.normalAt(0, 0))
            heights = numpy.abs((prisms[:, 3:] - prisms[:, :3]) @ normal)
            self.assertLess(abs(numpy.median(heights) - 0.1), 1e-9)
        self.assertEqual(len(prisms_on(self.obj.FemMesh, "Face2")), 0)
        triangles = sum(len(prisms_on(self.obj.FemMesh, name)) for name in ("Face1", "Face5"))
        self.assertEqual(number_of(self.obj.FemMesh, PRISMS), 4 * triangles)

    def test_all_outer_faces_by_default(self):
        self.on()
        report = mesh_object.remesh(self.obj)
        self.assertEqual(len(report["layers"]["patches"]), 6)
        self.assertEqual(number_of(self.obj.FemMesh, PRISMS), report["layers"]["prisms"])
        self.assertEqual(number_of(self.obj.FemMesh, TETS), report["mesh"]["tets"])
        solid = self.obj.FemMesh.getGroupElements(groups.named(self.obj.FemMesh)["Solid1"])
        self.assertEqual(set(solid), set(self.obj.FemMesh.Volumes))

    def test_total_thickness(self):
        layers = self.on("Face1")
        layers.Thickness, layers.Count, layers.FirstHeight = 0.7, 3, 5
        layers.Growth = 2
        mesh_object.remesh(self.obj)
        prisms = prisms_on(self.obj.FemMesh, "Face1")
        heights = numpy.abs(prisms[:, 3:, 0] - prisms[:, :3, 0])
        self.assertLess(abs(numpy.median(heights) - 0.1), 1e-9)

    def test_second_order_and_tetrahedra(self):
        layers = self.on("Face1")
        self.obj.ElementOrder = "2nd"
        mesh_object.remesh(self.obj)
        self.assertEqual(elements.order(self.obj.FemMesh), 2)
        self.assertGreater(number_of(self.obj.FemMesh, (15,)), 0)
        self.obj.LayersAsTetrahedra = True
        mesh_object.remesh(self.obj)
        self.assertEqual(number_of(self.obj.FemMesh, (10,)), self.obj.FemMesh.VolumeCount)
        self.document.removeObject(layers.Name)
        mesh_object.remesh(self.obj)
        self.assertEqual(self.obj.MeshLayerList, [])

    def test_several_with_settings_of_their_own(self):
        first, second = self.on("Face1"), self.on()
        first.Count, second.Count = 2, 4
        self.assertEqual([text.split(":")[0] for text in layer_objects.words_of(self.obj)], ["1", "all"])
        report = mesh_object.remesh(self.obj)
        self.assertEqual(len(report["layers"]["patches"]), 6)

    def test_on_one_side_of_an_interface(self):
        """Face2 of the second block is the mesh's Face of the first one where they touch."""
        self.part.Shape = Part.Compound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 0, 0))])
        faces = {round(face.CenterOfMass.x, 6): f"Face{i}" for i, face in enumerate(self.part.Shape.Faces, 1)
                 if i > 6 and abs(face.normalAt(0, 0).x) > 0.5}
        layers = self.on(faces[10])
        report = mesh_object.remesh(self.obj)
        both = report["layers"]["prisms"]
        layers.References = [(self.part, (faces[10],)), (self.part, ("Solid2",))]
        report = mesh_object.remesh(self.obj)
        self.assertEqual(2 * report["layers"]["prisms"], both)
        inside = self.obj.FemMesh.getGroupElements(groups.named(self.obj.FemMesh)["Solid2"])
        prisms = [each for each in self.obj.FemMesh.Volumes if len(self.obj.FemMesh.getElementNodes(each)) in PRISMS]
        self.assertLessEqual(set(prisms), set(inside))

    def test_what_is_wrong_is_told_with_the_object(self):
        other = self.document.addObject("Part::Feature", "Other")
        other.Shape = Part.makeBox(1, 1, 1)
        layers = self.on("Face1")
        layers.References = [(other, ("Face1",))]
        self.assertIn("BoundaryLayers refers to Other, but Block is meshed", self.told())
        layers.References = [(self.part, ("Edge1",))]
        self.assertIn("BoundaryLayers: Edge1 is no face", self.told())
        layers.References = [(self.part, ("Face1",))]
        layers.Growth = 0.5
        self.assertIn("Growth is 0.5; it has to be 1 to 10", self.told())
        layers.Growth, layers.Count = 1.2, 0
        self.assertIn("Count is 0", self.told())
        layers.Count = 3
        mesh_object.remesh(self.obj)
        self.obj.PeriodicFaces = ["x"]
        self.assertIn("layers", self.told())
        self.part.Shape = Part.makeSphere(3)
        layers.References = [(self.part, ("Face5",))]
        self.assertIn("has no Face5 any more", self.told())

    def test_places_of_lower_layers_and_pyramids(self):
        """At the sharp edge of a wedge, layers end in pyramids."""
        self.part.Shape = wedge(8)
        self.obj.ElementOrder = "2nd"
        self.on()
        report = mesh_object.remesh(self.obj)
        self.assertGreater(report["layers"]["pyramids"], 0)
        self.assertIn("of second order are inexact in CalculiX", " ".join(report["notes"]))
        found = [each for each in places.in_report(report) if each.kind == places.LAYERS]
        self.assertTrue(any("so sharply" in each.text and each.points for each in found), found)
        self.assertTrue(any(each.subshapes for each in found), found)
        self.assertTrue(all(not messages for _, messages in guarantees.guarantees(report)))
        self.assertGreater(len(guarantees.guarantees(report)), 7)
        (place, *_) = worst_elements.in_report(self.obj.FemMesh, report)
        number = int(place.text.split()[-1])
        corners = [tuple(self.obj.FemMesh.Nodes[n]) for n in self.obj.FemMesh.getElementNodes(number)[:4]]
        self.assertLess(numpy.abs(numpy.sort(corners, axis=0) - numpy.sort(place.tetrahedra[0], axis=0)).max(), 1e-9)

    def test_a_change_makes_the_mesh_out_of_date(self):
        layers = self.on("Face1")
        mesh_object.remesh(self.obj)
        self.assertFalse(up_to_date.is_out_of_date(self.obj))
        layers.Count = 5
        self.assertTrue(up_to_date.is_out_of_date(self.obj))
        layers.Count = 3
        self.assertFalse(up_to_date.is_out_of_date(self.obj))

    def test_shells_have_none(self):
        self.on()
        self.obj.ElementDimension = "2D"
        mesh_object.remesh(self.obj)
        self.assertEqual(self.obj.FemMesh.VolumeCount, 0)

    def test_macros_of_the_program_s_texts(self):
        obj = collarmesh_workbench.mesh(self.part, size=3, order=1, layers=[
                                        "1:first=0.2,count=2", "5"], layers_tets=True)
        self.assertEqual(number_of(obj.FemMesh, TETS), obj.FemMesh.VolumeCount)
        settings = program.Settings(layers=["1", "all:count=2"], layers_tets=True)
        self.assertEqual(" ".join(settings.arguments()[-5:]), "--layers-tets --layers 1 --layers all:count=2")

    def test_save_and_reopen(self):
        layers = self.on("Face1", "Face3")
        layers.FirstHeight, layers.Count = 0.2, 5
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "layers.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
        obj = self.document.getObject("FEMMeshCollarmesh")
        (layers,) = obj.MeshLayerList
        self.assertTrue(layer_objects.is_ours(layers))
        self.assertEqual(layer_objects.words_of(obj), ["1,3:growth=1.2,count=5,first=0.2"])
        mesh_object.remesh(obj)

    def test_those_of_gmsh_are_taken_over(self):
        old = ObjectsFem.makeMeshGmsh(self.document, "Old")
        for name in ("Shape", "Part"):
            if name in old.PropertiesList:
                setattr(old, name, self.part)
        faces, edges = (ObjectsFem.makeMeshBoundaryLayer(self.document, old) for _ in range(2))
        faces.References, edges.References = [(self.part, ("Face1",))], [(self.part, ("Edge1",))]
        faces.MinimumThickness, faces.NumberOfLayers, faces.GrowthRate, faces.Label = 0.3, 4, 1.5, "Wall"
        new, notes = take_over.take_over(old)
        (layers,) = new.MeshLayerList
        self.assertEqual((layers.Label, layer_objects.words_of(new)), ("Wall", ["1:growth=1.5,count=4,first=0.3"]))
        self.assertIn(edges.Label, " ".join(notes))
        gmsh, notes = take_over.hand_over(new)
        self.assertIn("Wall", " ".join(notes))
        ours, _ = take_over.take_over(gmsh)
        self.assertEqual(ours.MeshLayerList, [layers])


class Solved(unittest.TestCase):
    """A bar with layers is pulled: CalculiX takes prisms of both orders."""

    def test_pulled_bar(self):
        if shutil.which("ccx") is None:
            self.skipTest("CalculiX is not installed")
        for order in (1, 2):
            bar = Analysis(Part.makeBox(20, 5, 5))
            bar.hold("x", (0, 2.5, 2.5))
            bar.hold("y", (10, 0, 2.5))
            bar.hold("z", (10, 2.5, 0))
            bar.pull((20, 2.5, 2.5), 250, (1, 0, 0))
            bar.mesh(order, 2, layers=["all"])
            self.assertGreater(number_of(bar.mesh_object.FemMesh, PRISMS), 0)
            found = bar.solve()
            self.assertAlmostEqual(found["displacement"] / (20 * 10 / 210000), 1, delta=0.02)
            self.assertAlmostEqual(found["stress"], 10, delta=0.1)
            self.assertAlmostEqual(found["reactions"][0], -250, delta=0.5)
            bar.close()


run_in_freecad.run(Layers, Solved)
