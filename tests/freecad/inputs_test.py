"""Inputs: bodies, compounds, links to other documents, containers, triangle meshes; and whether a mesh is
outdated after changes of them. Run by run.py."""

import os
import sys
import tempfile
import unittest

import FreeCAD
import Mesh
import ObjectsFem
import Part
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import inputs, mesh_object, size_objects, up_to_date
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402

MOVED = FreeCAD.Vector(100, 0, 0)


def groups(fem_mesh):
    return {fem_mesh.getGroupName(n): fem_mesh.getGroupElements(n) for n in fem_mesh.Groups}


def volume(fem_mesh):
    total = 0
    for element in fem_mesh.Volumes:
        a, b, c, d = (fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:4])
        total -= (b - a).cross(c - a).dot(d - a) / 6
    return total


def area(fem_mesh, elements):
    total = 0
    for element in elements:
        a, b, c = (fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:3])
        total += (b - a).cross(c - a).Length / 2
    return total


class WithDocument(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")

    def tearDown(self):
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)

    def add(self, kind, name, **properties):
        obj = self.document.addObject(kind, name)
        for key, value in properties.items():
            setattr(obj, key, value)
        return obj

    def require_box(self, obj, size, at):
        """Checks that there is a mesh of a box, at the right place, with its six faces."""
        fem_mesh = obj.FemMesh
        self.assertAlmostEqual(volume(fem_mesh), size[0] * size[1] * size[2], places=4)
        box = fem_mesh.BoundBox
        self.assertLess(FreeCAD.Vector(box.XMin, box.YMin, box.ZMin).distanceToPoint(at), 1e-6)
        self.assertEqual(
            {name for name in groups(fem_mesh) if name.startswith("Face")}, {f"Face{i}" for i in range(1, 7)}
        )


class Shapes(WithDocument):
    def test_body(self):
        body = self.document.addObject("PartDesign::Body", "Body")
        pad = self.document.addObject("PartDesign::AdditiveBox", "Block")
        body.addObject(pad)
        pad.Length, pad.Width, pad.Height = 10, 6, 4
        body.Placement.Base = MOVED
        self.document.recompute()
        self.require_box(collarmesh_workbench.mesh(body, size=2), (10, 6, 4), MOVED)

    def test_compound_and_container(self):
        boxes = [self.add("Part::Box", f"Box{i}", Length=5, Width=5, Height=5) for i in (1, 2)]
        boxes[1].Placement.Base = MOVED
        compound = self.add("Part::Compound", "Compound", Links=boxes)
        self.document.recompute()
        fem_mesh = collarmesh_workbench.mesh(compound, size=2).FemMesh
        self.assertAlmostEqual(volume(fem_mesh), 250, places=4)
        self.assertIn("Solid2", groups(fem_mesh))
        container = self.add("App::Part", "Container")
        container.addObject(compound)
        for box in boxes:  # only visible objects count, and the boxes came into the container with the compound
            box.Visibility = False
        self.document.recompute()
        self.assertAlmostEqual(volume(collarmesh_workbench.mesh(container, size=2).FemMesh), 250, places=4)

    def test_link_to_another_document(self):
        with tempfile.TemporaryDirectory() as folder:
            library = FreeCAD.newDocument("library")
            block = library.addObject("Part::Box", "Block")
            block.Length, block.Width, block.Height = 8, 6, 4
            library.recompute()
            library.saveAs(os.path.join(folder, "library.FCStd"))
            self.document.saveAs(os.path.join(folder, "here.FCStd"))
            link = self.add("App::Link", "Link", LinkedObject=block)
            link.LinkPlacement = FreeCAD.Placement(MOVED, FreeCAD.Rotation())
            self.document.recompute()
            obj = mesh_object.make(self.document, link)
            obj.CharacteristicLengthMax = 2
            finer = size_objects.make(obj, "Distance", 0.5)
            finer.References = [(link, ("Face1",))]
            mesh_object.remesh(obj)
            self.require_box(obj, (8, 6, 4), MOVED)
            on_it = groups(obj.FemMesh)["Face1"]
            self.assertGreater(len(on_it), 6 * 4 / 0.5**2)
            nodes = {node for element in on_it for node in obj.FemMesh.getElementNodes(element)}
            self.assertEqual(set(obj.FemMesh.getNodesByFace(link.Shape.Face1)), nodes)
            self.assertFalse(up_to_date.is_out_of_date(obj))
            block.Length = 9
            library.recompute()
            self.document.recompute()
            self.assertTrue(up_to_date.is_out_of_date(obj))

    def test_what_the_button_takes(self):
        box = self.add("Part::Box", "Box")
        taken = [box, self.add("App::Link", "Link", LinkedObject=box),
                 self.document.addObject("App::Part", "Container"), self.document.addObject("PartDesign::Body", "Body"),
                 self.document.addObject("Mesh::Feature", "Mesh")]
        refused = [self.document.addObject("App::DocumentObjectGroup", "Folder"), mesh_object.make(self.document, box),
                   ObjectsFem.makeMeshGmsh(self.document), self.document.addObject("App::Link", "Dangling")]
        for obj in taken + refused:
            self.assertEqual(inputs.can_be_meshed(obj), obj in taken, obj.Name)

    def test_what_cannot_be_meshed_is_told(self):
        empty = self.document.addObject("Mesh::Feature", "Empty")
        with self.assertRaisesRegex(MesherError, "Empty has no triangles"):
            collarmesh_workbench.mesh(empty)
        open_box = Mesh.createBox(4, 4, 4)
        open_box.removeFacets([0, 1, 2])
        with self.assertRaisesRegex(MesherError, r"\("):  # the message has a place
            collarmesh_workbench.mesh(self.add("Mesh::Feature", "Open", Mesh=open_box), repair="none")
        self.assertEqual([each.Name for each in self.document.Objects], ["Empty", "Open"])


class WithoutVolume(WithDocument):
    """Shapes without solids that are to be filled with tetrahedra (shells_test.py has others)."""

    def refused(self, shape, words, **options):
        with self.assertRaisesRegex(MesherError, words):
            collarmesh_workbench.mesh(self.add("Part::Feature", "Surface", Shape=shape), size=3, dimension=3, **options)

    def test_faces_and_wires(self):
        box = Part.makeBox(10, 10, 10)
        self.refused(box.Faces[0], "Surface[0-9]* is a face.*2D in .*for shells")
        self.refused(box.Faces[0], "is a face", fill_holes=True)
        self.refused(Part.Wire(box.Faces[0].Edges), "edges or points only.*1D in .*for beams")
        self.refused(Part.Vertex(1, 2, 3), "edges or points only")

    def test_open_surfaces_are_filled_on_request(self):
        surface = Part.makeShell(Part.makeBox(10, 10, 10).Faces[:5])
        self.refused(surface, "open at 4 edges.*Fill holes of open surfaces")
        part = self.add("Part::Feature", "Surface", Shape=surface)
        for dimension in (0, 3):
            obj = collarmesh_workbench.mesh(part, size=3, fill_holes=True, dimension=dimension)
            self.assertAlmostEqual(volume(obj.FemMesh), 1000, places=3)
            self.assertTrue(obj.FillHoles)

    def test_closed_surfaces_are_volumes(self):
        loose = Part.makeCompound([Part.Face(face.OuterWire) for face in Part.makeBox(10, 10, 10).Faces])
        for shape in (loose, Part.makeShell(Part.makeBox(10, 10, 10).Faces)):
            obj = collarmesh_workbench.mesh(self.add("Part::Feature", "Surface", Shape=shape), size=3)
            self.assertAlmostEqual(volume(obj.FemMesh), 1000, places=3)
        ball = self.add("Part::Feature", "Ball", Shape=Part.makeSphere(5).Faces[0])
        self.assertGreater(volume(collarmesh_workbench.mesh(ball, size=2).FemMesh), 500)


class Triangles(WithDocument):
    def box(self, segments=()):
        mesh = Mesh.createBox(4, 4, 4)
        for segment in segments:
            mesh.addSegment(segment)
        return self.add("Mesh::Feature", "Box", Mesh=mesh)

    def test_faces_are_found_by_their_angles(self):
        obj = collarmesh_workbench.mesh(self.box(), size=1)
        self.assertAlmostEqual(volume(obj.FemMesh), 64, places=4)
        sides = [elements for name, elements in groups(obj.FemMesh).items() if name.startswith("patch")]
        self.assertEqual([round(area(obj.FemMesh, elements), 4) for elements in sides], [16] * 6)

    def test_segments_are_groups(self):
        part = self.box([[0, 1], [2]])
        part.Placement.Base = MOVED
        expected = {}
        for number in range(2):
            expected[f"Segment{number + 1}"] = sum(
                part.Mesh.Facets[i].Area for i in part.Mesh.getSegment(number)
            )
        expected["Rest"] = part.Mesh.Area - sum(expected.values())
        obj = collarmesh_workbench.mesh(part, size=1)
        found = groups(obj.FemMesh)
        for name, size in expected.items():
            self.assertAlmostEqual(area(obj.FemMesh, found[name]), size, places=4)
        self.assertAlmostEqual(obj.FemMesh.BoundBox.Center.x, 100, places=4)

    def test_stl_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.stl")
            Mesh.createSphere(5, 40).write(path)
            Mesh.insert(path, self.document.Name)
        part = self.document.Objects[0]
        obj = collarmesh_workbench.mesh(part, size=1.5, order=2)
        self.assertAlmostEqual(volume(obj.FemMesh) / part.Mesh.Volume, 1, delta=0.03)
        self.assertEqual(len(obj.FemMesh.getElementNodes(obj.FemMesh.Volumes[0])), 10)

    def test_link_to_triangles(self):
        link = self.add("App::Link", "Link", LinkedObject=self.box([[0, 1]]))
        link.LinkPlacement = FreeCAD.Placement(MOVED, FreeCAD.Rotation())
        self.document.recompute()
        obj = collarmesh_workbench.mesh(link, size=1)
        self.assertAlmostEqual(obj.FemMesh.BoundBox.Center.x, 100, places=4)
        self.assertIn("Segment1", groups(obj.FemMesh))

    def test_out_of_date(self):
        part = self.box([[0, 1]])
        obj = collarmesh_workbench.mesh(part, size=2)
        self.assertFalse(up_to_date.is_out_of_date(obj))
        mesh = part.Mesh.copy()
        mesh.addSegment([2, 3])
        part.Mesh = mesh
        self.assertTrue(up_to_date.is_out_of_date(obj))
        mesh_object.remesh(obj)
        self.assertFalse(up_to_date.is_out_of_date(obj))

    def test_in_an_analysis(self):
        analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")
        analysis.addObject(ObjectsFem.makeMaterialSolid(self.document, "Steel"))
        obj = collarmesh_workbench.mesh(self.box([[0, 1]]), size=2, analysis=analysis)
        self.assertIn("Segment1", groups(obj.FemMesh))


class OutOfDate(WithDocument):
    def setUp(self):
        super().setUp()
        self.box = self.add("Part::Box", "Box", Length=10, Width=8, Height=6)
        self.part = self.add("Part::Fillet", "Part", Base=self.box)
        self.document.recompute()
        self.part.Edges = [(1, 1.0, 1.0)]
        self.document.recompute()
        self.obj = mesh_object.make(self.document, self.part)
        self.obj.CharacteristicLengthMax = 3
        self.size = size_objects.make(self.obj, "Sphere", 1)
        mesh_object.remesh(self.obj)
        self.document.recompute()

    def is_out_of_date(self):
        """Returns whether it is out of date after a recompute, which never makes a mesh."""
        before = self.obj.FemMesh.NodeCount, self.obj.FemMesh.VolumeCount
        self.document.recompute()
        self.assertEqual((self.obj.FemMesh.NodeCount, self.obj.FemMesh.VolumeCount), before)
        return up_to_date.is_out_of_date(self.obj)

    def test_nothing_changed(self):
        self.assertFalse(self.is_out_of_date())
        self.part.Shape.tessellate(0.01)
        for each in self.document.Objects:
            each.touch()
        self.assertFalse(self.is_out_of_date())
        self.obj.Label = "Another name"
        self.obj.TimeLimit = 100
        self.assertFalse(self.is_out_of_date())

    def test_the_shape_changed_and_back(self):
        for change in (lambda: setattr(self.box, "Length", 10.001),
                       lambda: setattr(self.part, "Edges", [(1, 1.1, 1.1)]),
                       lambda: setattr(self.part, "Edges", [(2, 1.0, 1.0)])):
            change()
            self.assertTrue(self.is_out_of_date())
            self.box.Length = 10
            self.part.Edges = [(1, 1.0, 1.0)]
            self.assertFalse(self.is_out_of_date())

    def test_sizes_and_settings_changed(self):
        size, obj = self.size, self.obj
        for holder, name, value in ((size, "Radius", 2), (size, "Size", 0.5), (size, "Growth", 0.2),
                                    (obj, "ElementOrder", "1st"), (obj, "CharacteristicLengthMax", 2),
                                    (obj, "MeshSizeList", [])):
            with self.subTest(name):
                before = getattr(holder, name)
                self.assertFalse(self.is_out_of_date())
                setattr(holder, name, value)
                self.assertTrue(self.is_out_of_date())
                setattr(holder, name, before)
        region = ObjectsFem.makeMeshRegion(self.document, obj, 0.5)
        region.References = [(self.part, "Face1")]
        self.assertTrue(self.is_out_of_date())
        self.document.removeObject(region.Name)
        group = ObjectsFem.makeMeshGroup(self.document, obj)
        group.References = [(self.part, "Face1")]
        self.assertTrue(self.is_out_of_date())
        mesh_object.remesh(obj)
        self.assertFalse(self.is_out_of_date())

    def test_the_shape_is_gone(self):
        self.document.removeObject(self.part.Name)
        self.assertTrue(self.is_out_of_date())

    def test_edited_while_meshing(self):
        edited = []

        def edit(_step):
            if not edited:
                edited.append(True)
                self.box.Length = 20
                self.document.recompute()

        mesh_object.remesh(self.obj, edit)
        self.assertAlmostEqual(self.obj.FemMesh.BoundBox.XLength, 10, places=4)
        self.assertTrue(self.is_out_of_date())
        mesh_object.remesh(self.obj)
        self.assertAlmostEqual(self.obj.FemMesh.BoundBox.XLength, 20, places=4)
        self.assertFalse(self.is_out_of_date())

    def test_reopened(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "part.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
        self.obj, self.box = self.document.getObject("FEMMeshCollarmesh"), self.document.getObject("Box")
        self.assertFalse(self.is_out_of_date())
        self.box.Length = 11
        self.assertTrue(self.is_out_of_date())

    def test_undo_and_redo_of_a_meshing(self):
        self.document.UndoMode = 1
        counts = [self.obj.FemMesh.VolumeCount]
        self.document.openTransaction("Size")
        self.obj.CharacteristicLengthMax = 1.5
        self.document.commitTransaction()
        mesh_object.remesh(self.obj)
        counts.append(self.obj.FemMesh.VolumeCount)
        names = set(groups(self.obj.FemMesh))
        self.assertNotEqual(*counts)
        self.document.undo()
        self.assertEqual(self.obj.FemMesh.VolumeCount, counts[0])
        self.assertTrue(up_to_date.is_out_of_date(self.obj))  # the size is still the new one
        self.document.undo()
        self.assertEqual(self.obj.CharacteristicLengthMax.Value, 3)
        self.assertFalse(up_to_date.is_out_of_date(self.obj))
        self.document.redo()
        self.document.redo()
        self.assertEqual(self.obj.FemMesh.VolumeCount, counts[1])
        self.assertEqual(set(groups(self.obj.FemMesh)), names)
        self.assertFalse(up_to_date.is_out_of_date(self.obj))

    def test_numbers_of_real_parts_are_kept_by_files(self):
        """FreeCAD writes 16 digits and OpenCASCADE normalizes what it reads."""
        shapes = [
            Part.makeTorus(10, 3),
            Part.makeCone(3, 1, 7),
            Part.makeSphere(3).fuse(Part.makeBox(4, 4, 4)),
        ]
        before = {}
        for i, shape in enumerate(shapes):
            shape.rotate(FreeCAD.Vector(), FreeCAD.Vector(1, 2, 3), 17)
            part = self.add("Part::Feature", f"Shape{i}", Shape=shape)
            before[part.Name] = up_to_date.shape_numbers(part)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "part.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
        for name, numbers in before.items():
            part = self.document.getObject(name)
            self.assertTrue(up_to_date.same_shape(numbers, up_to_date.shape_numbers(part)), name)
            part.Placement.Base = part.Placement.Base + FreeCAD.Vector(1e-6, 0, 0)
            self.assertFalse(up_to_date.same_shape(numbers, up_to_date.shape_numbers(part)), name)


run_in_freecad.run(Shapes, WithoutVolume, Triangles, OutOfDate)
