"""Solids that touch: all numbers of a common face can be used for sizes, groups, constraints and messages.
Run by run.py."""

import os
import sys
import unittest

import FreeCAD
import ObjectsFem
import Part
from femmesh import meshtools
from freecad.collarmesh_workbench import contacts, mesh_object, size_objects, subshape_words

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402
from contacts_shapes import BESIDE, area, boss, boxes, groups, hub  # noqa: E402


class Contacts(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def mesh_of(self, shape, size, sizes=()):
        """`sizes`: (name of a face or an edge, size)."""
        part = self.document.addObject("Part::Feature", "Part")
        part.Shape = shape
        obj = mesh_object.make(self.document, part)
        obj.CharacteristicLengthMax = size
        for name, smaller in sizes:
            region = ObjectsFem.makeMeshRegion(self.document, obj, smaller)
            region.References = [(part, name)]
        return obj

    def test_numbers_in_the_mesh(self):
        here = contacts.of(boxes())
        self.assertEqual((here.tags("Face", 7), here.tags("Face", 2), here.tags("Face", 8)), ([2], [2], [8]))
        self.assertEqual((here.name("Face", 2), here.name("Face", 8)), ("Face2 = Face7", "Face8"))
        self.assertEqual(here.glued_faces(), [(2, 7)])
        self.assertEqual(here.in_contact("Edge"), [13, 14, 15, 16])
        here = contacts.of(hub())
        self.assertEqual((here.tags("Face", 8), here.tags("Face", 7)), ([7, 8], [7]))
        self.assertTrue(here.has_all("Face", 7, 8))
        here = contacts.of(boss())
        self.assertEqual((here.tags("Face", 9), here.has_all("Face", 6, 9)), ([6], False))

    def test_solids_that_share_faces_already(self):
        fragments, _ = Part.makeBox(10, 10, 10).generalFuse([Part.makeBox(10, 10, 10, BESIDE)])
        here = contacts.of(fragments)
        self.assertEqual(here.in_contact("Face"), [])
        ((first, second),) = here.glued_faces()
        self.assertEqual(first, second)
        self.assertEqual(fragments.getElement(f"Face{first}").CenterOfMass.x, 10)

    def test_what_does_not_touch(self):
        apart = Part.makeBox(10, 10, 10, FreeCAD.Vector(10.01, 0, 0))
        side_by_side = Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 10, 0))  # they touch along an edge
        for other in (apart, side_by_side):
            self.assertEqual(contacts.of(Part.makeCompound([Part.makeBox(10, 10, 10), other])).glued_faces(), [])
        self.assertEqual(contacts.of(Part.makeBox(1, 1, 1)).glued_faces(), [])
        self.assertEqual(contacts.of(Part.Shape()).tags("Face", 7), [7])

    def test_sizes_on_both_numbers_of_a_face(self):
        counts = []
        for name in ("Face2", "Face7", "Edge14", "Edge6"):
            obj = self.mesh_of(boxes(), 4, [(name, 1)])
            mesh_object.remesh(obj)
            counts.append(obj.FemMesh.VolumeCount)
        self.assertEqual((counts[0], counts[2]), (counts[1], counts[3]))
        plain = self.mesh_of(boxes(), 4)
        mesh_object.remesh(plain)
        self.assertGreater(min(counts), plain.FemMesh.VolumeCount)

    def test_sizes_near_both_numbers_of_a_face(self):
        counts = []
        for name in ("Face2", "Face7"):
            obj = self.mesh_of(boxes(), 4)
            size = size_objects.make(obj, "Distance", 1)
            size.References = [(obj.Part, (name,))]
            mesh_object.remesh(obj)
            counts.append(obj.FemMesh.VolumeCount)
        self.assertEqual(*counts)

    def test_the_smallest_of_several_sizes_counts(self):
        obj = self.mesh_of(boxes(), 4, [("Face2", 2), ("Face7", 1)])
        settings = mesh_object.mesh_properties.settings_of(obj)
        self.assertEqual(contacts.in_mesh_numbers(settings, obj.Part.Shape).face_sizes, {2: 1})

    def test_groups_of_all_numbers(self):
        for shape in (boxes(), hub(), boss()):
            obj = self.mesh_of(shape, 3)
            mesh_object.remesh(obj)
            found = groups(obj.FemMesh)
            for number, face in enumerate(shape.Faces, 1):
                self.assertAlmostEqual(
                    area(obj.FemMesh, found[f"Face{number}"]) / face.Area, 1, delta=0.02, msg=f"Face{number}")
        obj = self.mesh_of(boxes(), 3)
        mesh_object.remesh(obj)
        found = groups(obj.FemMesh)
        self.assertEqual((found["Face2"], found["Edge6"]), (found["Face7"], found["Edge14"]))

    def test_groups_of_ones_own_and_constraints(self):
        obj = self.mesh_of(boxes(), 3)
        group = ObjectsFem.makeMeshGroup(self.document, obj)
        group.References = [(obj.Part, ("Face7",))]
        mesh_object.remesh(obj)
        found = groups(obj.FemMesh)
        self.assertEqual(found[f"{group.Name}_Faces"], found["Face2"])
        fixed = ObjectsFem.makeConstraintFixed(self.document)
        fixed.References = [(obj.Part, "Face7")]
        nodes = set(meshtools.get_femnodes_by_femobj_with_references(obj.FemMesh, {"Object": fixed}))
        self.assertEqual(nodes, {n for e in found["Face2"] for n in obj.FemMesh.getElementNodes(e)})

    def test_messages(self):
        names = contacts.of(boxes()).name
        for text, expected in (
            ("Patch 1 (tag 2) at (1, 2, 3) has no faces", "Face2 = Face7 at (1, 2, 3) has no faces"),
            ("Region 1 (tag 1) has a volume", "Solid1 has a volume"),
            ("its curve 4 (tag 5)", "its Edge5 = Edge13"),
        ):
            self.assertEqual(subshape_words.in_names(text, names), expected)

    def test_a_face_that_is_not_there_is_told(self):
        obj = self.mesh_of(boxes(), 3, [("Face99", 1)])
        with self.assertRaisesRegex(Exception, "99"):
            mesh_object.remesh(obj)

    def test_what_the_program_says_of_a_run(self):
        obj = self.mesh_of(boxes(), 3)
        with mesh_object.start(obj) as job:
            job.heard("warning: Face 3 of patch 1 (tag 2) is 0.1 away from the patch at (10, 5, 5)")
            mesh_object.finish(obj, job, job.run())
            report = job.report()
        self.assertEqual(job.messages[0], "warning: Face 3 of Face2 = Face7 is 0.1 away from the patch at (10, 5, 5)")
        self.assertEqual(report["check"]["findings"], [])


run_in_freecad.run(Contacts)
