"""Constraints on groups of a mesh of triangles, up to the results of CalculiX. Run by run.py."""

import os
import sys
import tempfile
import unittest

import FreeCAD
import Mesh
import ObjectsFem
import Part
from femmesh import meshtools
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import constraint_faces, mesh_object
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import analysis  # noqa: E402
import run_in_freecad  # noqa: E402

LENGTH, WIDTH, HEIGHT, RADIUS = 40, 20, 12, 6
PRESSURE, FORCE = 5, 1000
GROOVE, BOTTOM = (LENGTH / 2, WIDTH / 2, HEIGHT - RADIUS), (LENGTH / 2, WIDTH / 2, 0)


def grooved():
    """A block with a semicircular groove along its top."""
    return Part.makeBox(LENGTH, WIDTH, HEIGHT).cut(
        Part.makeCylinder(RADIUS, LENGTH, FreeCAD.Vector(0, WIDTH / 2, HEIGHT), FreeCAD.Vector(1, 0, 0)))


class OfTriangles(analysis.Analysis):
    """An analysis of triangles. A place stands for the group with the element nearest to it."""

    def __init__(self, shape):
        super().__init__(Part.Shape())
        self.document.removeObject(self.part.Name)
        self.part = self.document.addObject("Mesh::Feature", "Triangles")
        self.part.Mesh = Mesh.Mesh(shape.tessellate(0.02))

    def mesh(self, order, size):
        self.mesh_object = collarmesh_workbench.mesh(self.part, analysis=self.analysis, size=size, order=order)

    def group_at(self, place):
        place = FreeCAD.Vector(*place)
        fem_mesh = self.mesh_object.FemMesh
        best = {}
        for number in fem_mesh.Groups:
            if fem_mesh.getGroupElementType(number) == "Face":
                for element in fem_mesh.getGroupElements(number):
                    corners = [fem_mesh.getNodeById(node) for node in fem_mesh.getElementNodes(element)[:3]]
                    middle = (corners[0] + corners[1] + corners[2]) / 3
                    distance = middle.distanceToPoint(place)
                    if not best or distance < best["distance"]:
                        best = {"distance": distance, "name": fem_mesh.getGroupName(number)}
        return best["name"]

    def faces(self, *places):
        return collarmesh_workbench.references_to_groups(self.mesh_object, *(self.group_at(place) for place in places))


class Solved(unittest.TestCase):
    """Compares with the same analysis of the solid from which the triangles were made."""

    def tearDown(self):
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)

    def solved(self, kind, held, load):
        """Solves an analysis. The loaded face does not touch the held one: otherwise a part of the load would
        be missing in CalculiX's reactions."""
        each = kind(grooved())
        each.mesh(2, 4)
        each.hold("xyz", held)
        load(each)
        return each.solve()

    def compare(self, held, load, reaction):
        results = [self.solved(kind, held, load) for kind in (OfTriangles, analysis.Analysis)]
        for i in range(3):
            self.assertAlmostEqual(results[0]["reactions"][i], reaction[i], delta=1e-4 * FORCE)
        self.assertAlmostEqual(results[0]["displacement"] / results[1]["displacement"], 1, delta=0.02)

    def test_force_on_a_plane_group(self):
        self.compare((0, 3, 3), lambda each: each.pull((LENGTH, 3, 3), FORCE, (1, 0, 0)), (-FORCE, 0, 0))

    def test_force_on_a_curved_group(self):
        self.compare(BOTTOM, lambda each: each.pull(GROOVE, FORCE, (0, 0, 1)), (0, 0, -FORCE))

    def test_pressure_on_a_curved_group(self):
        self.compare(BOTTOM, lambda each: each.press(GROOVE, PRESSURE), (0, 0, PRESSURE * 2 * RADIUS * LENGTH))


class Groups(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.document.UndoMode = 1
        self.part = self.document.addObject("Mesh::Feature", "Triangles")
        self.part.Mesh = Mesh.Mesh(grooved().tessellate(0.02))
        self.analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")
        self.obj = collarmesh_workbench.mesh(self.part, analysis=self.analysis, size=5, order=1)

    def tearDown(self):
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)

    def fixed(self, *references):
        constraint = ObjectsFem.makeConstraintFixed(self.document, "Fixed")
        self.analysis.addObject(constraint)
        constraint.References = list(references)
        return constraint

    def nodes_of_group(self, name):
        fem_mesh = self.obj.FemMesh
        number = next(each for each in fem_mesh.Groups if fem_mesh.getGroupName(each) == name)
        return {node for each in fem_mesh.getGroupElements(number) for node in fem_mesh.getElementNodes(each)}

    def volume(self):
        """Returns the volume of the tetrahedra, with straight edges."""
        fem_mesh, total = self.obj.FemMesh, 0
        for element in fem_mesh.Volumes:
            a, b, c, d = (fem_mesh.getNodeById(node) for node in fem_mesh.getElementNodes(element))
            total += abs((b - a).cross(c - a).dot(d - a)) / 6
        return total

    def groups(self):
        return {self.obj.FemMesh.getGroupName(each) for each in self.obj.FemMesh.Groups
                if self.obj.FemMesh.getGroupElementType(each) == "Face"}

    def nodes_of(self, constraint):
        return set(meshtools.get_femnodes_by_femobj_with_references(self.obj.FemMesh, {"Object": constraint}))

    def test_faces(self):
        """Each group has its first face. Together the faces cover the surface, seen from outside."""
        faces = constraint_faces.make(self.obj)
        self.assertEqual(set(faces.Groups), self.groups())
        self.assertEqual(len(faces.Groups), len(faces.Shape.Faces))
        first = faces.Groups[:len(self.groups())]
        self.assertEqual(len(set(first)), len(first))
        self.assertAlmostEqual(faces.Shape.Area / self.part.Mesh.Area, 1, delta=5e-3)
        flux = sum((face.normalAt(0, 0).dot(face.CenterOfMass) * face.Area for face in faces.Shape.Faces), 0)
        self.assertAlmostEqual(flux / 3 / self.volume(), 1, places=4)
        self.assertIs(constraint_faces.make(self.obj), faces)

    def test_any_face_stands_for_its_group(self):
        faces = constraint_faces.make(self.obj)
        name = faces.Groups[-1]
        several = tuple(f"Face{i}" for i, group in enumerate(faces.Groups, 1) if group == name)
        self.assertGreater(len(several), 3)
        for chosen in ((several[-1],), several):
            constraint = self.fixed((faces, chosen))
            self.assertEqual(constraint.References, [(faces, (several[0],))])
            self.assertEqual(self.nodes_of(constraint), self.nodes_of_group(name))

    def test_other_references(self):
        """A plain list of links with the name of constraints' references stays as it is."""
        faces = constraint_faces.make(self.obj)
        other = self.document.addObject("App::FeaturePython", "Other")
        other.addProperty("App::PropertyLinkList", "References")
        constraint = self.fixed((faces, ("Face2",)))
        other.References = [faces, self.part]
        constraint_faces._Observer().slotChangedObject(other, "References")
        self.obj.CharacteristicLengthMax = 4
        mesh_object.remesh(self.obj)
        self.assertEqual(other.References, [faces, self.part])
        self.assertEqual(self.nodes_of(constraint), self.nodes_of_group(faces.Groups[1]))

    def test_force_on_a_group_and_a_face_of_a_part(self):
        """The group and the face get shares of the force by their areas; the group's share is spread over all
        of its faces."""
        faces, fem_mesh = constraint_faces.make(self.obj), self.obj.FemMesh
        curved = max(faces.Groups, key=faces.Groups.count)
        box = self.document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = LENGTH, WIDTH, HEIGHT
        self.document.recompute()
        bottom = next(i for i, each in enumerate(box.Shape.Faces, 1) if each.CenterOfMass.z == 0)
        force = ObjectsFem.makeConstraintForce(self.document, "Force")
        force.Force = FORCE
        force.References = [(faces, (f"Face{faces.Groups.index(curved) + 1}",)), (box, (f"Face{bottom}",))]
        tables = [table for _, table in meshtools.get_force_obj_face_nodeload_table(
            fem_mesh, meshtools.get_femelement_table(fem_mesh), fem_mesh.Nodes, force)]
        of_group, of_face = sorted(tables, key=lambda table: -max(fem_mesh.Nodes[node].z for node in table))
        self.assertEqual(set(of_group), self.nodes_of_group(curved))
        areas = [sum(face.Area for face, name in zip(faces.Shape.Faces, faces.Groups) if name == curved),
                 LENGTH * WIDTH]
        for table, area in zip((of_group, of_face), areas):
            self.assertAlmostEqual(sum(map(float, table.values())) / FORCE, area / sum(areas), delta=1e-3)

    def test_edges_are_those_of_the_faces(self):
        faces = constraint_faces.make(self.obj)
        edge = next(i for i, each in enumerate(faces.Shape.Edges, 1) if each.Length > LENGTH - 1e-3)
        constraint = self.fixed((faces, (f"Edge{edge}", "Face2")))
        on_edge = set(self.obj.FemMesh.getNodesByEdge(faces.Shape.Edges[edge - 1]))
        self.assertGreater(len(on_edge), 3)
        self.assertEqual(self.nodes_of(constraint), on_edge | self.nodes_of_group(faces.Groups[1]))

    def test_meshed_anew(self):
        """The constraint stays on its group, even if the group gets another number."""
        constraint = self.fixed(*collarmesh_workbench.references_to_groups(self.obj, "patch_3"))
        for size in (3, 8):
            self.obj.CharacteristicLengthMax = size
            mesh_object.remesh(self.obj)
            self.assertEqual(self.nodes_of(constraint), self.nodes_of_group("patch_3"))
        mesh = self.part.Mesh.copy()
        mesh.addSegment([0])
        mesh.addSegment([1, 2])
        self.part.Mesh = mesh
        notes = mesh_object.remesh(self.obj)["notes"]
        self.assertIn("Fixed is on the group patch_3, which the new mesh does not have; choose another one.", notes)
        self.assertEqual(constraint.References, [])
        constraint.References = collarmesh_workbench.references_to_groups(self.obj, "Segment2")
        before = constraint.References[0][1]
        mesh = self.part.Mesh.copy()
        mesh.removeFacets([])
        self.part.Mesh = mesh
        self.assertEqual(self.nodes_of(constraint), self.nodes_of_group("Segment2"))
        self.assertEqual(constraint.References[0][1], before)

    def test_undo_reopen_and_delete(self):
        constraint = self.fixed()
        wanted = collarmesh_workbench.references_to_groups(self.obj, "patch_2")
        self.document.openTransaction("References")
        constraint.References = wanted
        self.document.commitTransaction()
        self.document.undo()
        self.assertEqual(constraint.References, [])
        self.document.redo()
        nodes = self.nodes_of_group("patch_2")
        self.assertEqual(self.nodes_of(constraint), nodes)
        names = [each.Name for each in (constraint, self.obj)]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "part.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
            constraint, self.obj = map(self.document.getObject, names)
            self.assertEqual(self.nodes_of(constraint), nodes)
            faces = constraint_faces.of(self.obj)
            self.document.removeObject(faces.Name)
            self.assertEqual(constraint.References, [])
            self.assertIsNot(constraint_faces.make(self.obj), None)

    def test_what_has_no_such_faces(self):
        with self.assertRaisesRegex(MesherError, "no group of faces called patch_99; it has patch_1, patch_2"):
            collarmesh_workbench.references_to_groups(self.obj, "patch_99")
        solid = self.document.addObject("Part::Box", "Box")
        self.document.recompute()
        of_solid = collarmesh_workbench.mesh(solid, size=4)
        with self.assertRaisesRegex(MesherError, "made from a triangle mesh"):
            collarmesh_workbench.references_to_groups(of_solid, "Face1")

    def test_a_finely_curved_surface_has_few_faces(self):
        ball = self.document.addObject("Mesh::Feature", "Ball")
        ball.Mesh = Mesh.createSphere(10, 80)
        obj = collarmesh_workbench.mesh(ball, size=0.6)
        faces = constraint_faces.make(obj)
        self.assertLess(len(faces.Groups), 2001)
        self.assertAlmostEqual(faces.Shape.Area / ball.Mesh.Area, 1, delta=0.05)


run_in_freecad.run(Solved, Groups)
