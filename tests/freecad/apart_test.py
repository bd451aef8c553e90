"""Solids that are kept apart: each has its own nodes, groups and constraints, up to contact in CalculiX. Run
by run.py."""

import collections
import os
import sys
import unittest

import FreeCAD
import ObjectsFem
import Part
from femmesh import meshtools
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import mesh_object, take_over, up_to_date

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import analysis  # noqa: E402
import run_in_freecad  # noqa: E402
from contacts_shapes import BESIDE, area, boss, boxes, groups, hub  # noqa: E402


def row():
    """Returns three boxes; the middle one touches the other two."""
    return Part.makeCompound([Part.makeBox(10, 10, 10, FreeCAD.Vector(10 * i, 0, 0)) for i in range(3)])


def nodes_of(fem_mesh, elements):
    return {node for each in elements for node in fem_mesh.getElementNodes(each)}


def nodes_twice(fem_mesh):
    """Returns the number of places with several nodes."""
    places = collections.Counter(tuple(round(x, 9) for x in point) for point in fem_mesh.Nodes.values())
    return sum(count > 1 for count in places.values())


class Apart(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def mesh_of(self, shape, size=4, **options):
        return collarmesh_workbench.mesh(shape, self.document, size=size, **options)

    def expect_own_groups(self, shape, fem_mesh):
        """Checks that each face and edge has exactly the elements of its solid."""
        found = groups(fem_mesh)
        self.assertEqual([name for name in found if "_" in name], [])
        for i, solid in enumerate(shape.Solids, 1):
            of_solid = nodes_of(fem_mesh, found[f"Solid{i}"])
            for kind in ("Face", "Edge"):
                for number, each in enumerate(getattr(shape, kind + "s"), 1):
                    if any(each.isSame(other) for other in getattr(solid, kind + "s")) and f"{kind}{number}" in found:
                        self.assertLessEqual(nodes_of(fem_mesh, found[f"{kind}{number}"]), of_solid, f"{kind}{number}")
        for number, face in enumerate(shape.Faces, 1):
            self.assertAlmostEqual(area(fem_mesh, found[f"Face{number}"]) /
                                   face.Area, 1, delta=0.02, msg=f"Face{number}")

    def test_each_solid_has_its_own_nodes_and_groups(self):
        for shape in (boxes(), hub(), boss(), row()):
            for order in (1, 2):
                glued, apart = (self.mesh_of(shape, size=3, order=order,
                                keep_apart=keep).FemMesh for keep in (False, True))
                self.assertEqual(nodes_twice(glued), 0)
                self.assertEqual(nodes_twice(apart), apart.NodeCount - glued.NodeCount)
                self.assertGreater(nodes_twice(apart), 10)
                self.expect_own_groups(shape, apart)

    def test_edges_of_solids_that_touch(self):
        fem_mesh = self.mesh_of(boxes(), keep_apart=True).FemMesh
        found = groups(fem_mesh)
        for mine, other in (("Face2", "Face7"), ("Edge6", "Edge14")):
            self.assertEqual(len(found[mine]), len(found[other]))
            self.assertFalse(nodes_of(fem_mesh, found[mine]) & nodes_of(fem_mesh, found[other]))

    def test_a_face_that_two_solids_share_has_both_sides(self):
        fragments, _ = Part.makeBox(10, 10, 10).generalFuse([Part.makeBox(10, 10, 10, BESIDE)])
        name = next(f"Face{i}" for i, face in enumerate(fragments.Faces, 1) if abs(face.CenterOfMass.x - 10) < 1e-9)
        fem_mesh = self.mesh_of(fragments, keep_apart=True).FemMesh
        found = groups(fem_mesh)
        sides = [set(found[name + side]) for side in ("_minus", "_plus")]
        self.assertEqual(set(found[name]), sides[0] | sides[1])
        self.assertEqual([len(nodes_of(fem_mesh, side) & nodes_of(fem_mesh, found[f"Solid{i}"])) > 0
                          for i, side in enumerate(sides, 1)], [True, True])
        self.assertFalse(nodes_of(fem_mesh, sides[0]) & nodes_of(fem_mesh, sides[1]))

    def test_where_no_solids_touch_nothing_is_kept_apart(self):
        for shape in (Part.makeBox(10, 10, 10),
                      Part.makeCompound([Part.makeBox(9, 9, 9), Part.makeBox(9, 9, 9, BESIDE)])):
            obj = self.mesh_of(shape)
            obj.KeepApart = True
            with mesh_object.start(obj) as job:
                mesh_object.finish(obj, job, job.run())
            self.assertIn("warning: No two solids touch, so there is nothing to keep apart.", job.messages)
            self.assertEqual(nodes_twice(obj.FemMesh), 0)

    def test_groups_and_constraints_take_one_side(self):
        obj = self.mesh_of(boxes(), keep_apart=True)
        part = collarmesh_workbench.meshed_object(obj)
        group = ObjectsFem.makeMeshGroup(self.document, obj)
        group.References = [(part, ("Face7",))]
        mesh_object.remesh(obj)
        found = groups(obj.FemMesh)
        self.assertEqual(found[f"{group.Name}_Faces"], found["Face7"])
        fixed = ObjectsFem.makeConstraintFixed(self.document)
        for name in ("Face2", "Face7", "Face3", "Edge6", "Edge14"):  # Face3 ends at the contact
            fixed.References = [(part, name)]
            self.assertEqual(self.nodes_of_constraint(obj, fixed), nodes_of(obj.FemMesh, found[name]), name)

    def nodes_of_constraint(self, obj, constraint):
        return set(meshtools.get_femnodes_by_femobj_with_references(obj.FemMesh, {"Object": constraint}))

    def test_constraints_on_the_parts_of_a_compound(self):
        compound = self.document.addObject("Part::Compound", "Compound")
        for i in range(2):
            box = self.document.addObject("Part::Box", f"Box{i}")
            box.Placement.Base = FreeCAD.Vector(10 * i, 0, 0)
            compound.Links += [box]
        self.document.recompute()
        obj = self.mesh_of(compound, keep_apart=True)
        fixed = ObjectsFem.makeConstraintFixed(self.document)
        for box, name, in_compound in (("Box0", "Face2", "Face2"), ("Box1", "Face1", "Face7")):
            fixed.References = [(self.document.getObject(box), name)]
            self.assertEqual(self.nodes_of_constraint(obj, fixed),
                             nodes_of(obj.FemMesh, groups(obj.FemMesh)[in_compound]), box)

    def test_it_is_a_setting_of_the_mesh(self):
        obj = self.mesh_of(boxes())
        self.assertFalse(up_to_date.is_out_of_date(obj))
        obj.KeepApart = True
        self.assertTrue(up_to_date.is_out_of_date(obj))
        mesh_object.remesh(obj)
        self.assertFalse(up_to_date.is_out_of_date(obj))
        self.assertGreater(nodes_twice(obj.FemMesh), 0)

    def test_gmsh_calls_it_coherence(self):
        gmsh, _ = take_over.hand_over(self.mesh_of(boxes(), keep_apart=True))
        self.assertFalse(gmsh.CoherenceMesh)
        ours, _ = take_over.take_over(gmsh)
        self.assertTrue(ours.KeepApart)
        gmsh, _ = take_over.hand_over(self.mesh_of(boxes()))
        self.assertTrue(gmsh.CoherenceMesh)
        self.assertFalse(take_over.take_over(gmsh)[0].KeepApart)


class Solved(unittest.TestCase):
    """Two blocks of 10 mm side by side; the far end of the first one is held."""

    def setUp(self):
        self.analysis = analysis.Analysis(boxes())

    def tearDown(self):
        self.analysis.close()

    def mesh(self):
        self.analysis.mesh_object = collarmesh_workbench.mesh(
            self.analysis.part, analysis=self.analysis.analysis, size=5, order=1, keep_apart=True)

    def contact(self):
        pair = self.analysis.add(ObjectsFem.makeConstraintContact(self.analysis.document, "Contact"))
        pair.References = [(self.analysis.part, "Face2"), (self.analysis.part, "Face7")]

    def test_what_is_apart_feels_nothing_of_the_other(self):
        self.mesh()
        self.analysis.hold("xyz", (0, 5, 5), (20, 5, 5))
        self.analysis.pull((10, 5, 5), 1000, (1, 0, 0))  # pulls on Face2
        self.assertAlmostEqual(self.analysis.solve()["reactions"][0], -1000, delta=1e-3)
        self.assertGreater(self.farthest("Solid1"), 1e-4)
        self.assertEqual(self.farthest("Solid2"), 0)

    def farthest(self, solid):
        """Returns the largest displacement of the solid's nodes, mm."""
        result = next(each for each in self.analysis.analysis.Group if each.isDerivedFrom("Fem::FemResultObject"))
        fem_mesh = self.analysis.mesh_object.FemMesh
        nodes = nodes_of(fem_mesh, groups(fem_mesh)[solid])
        return max(length for node, length in zip(result.NodeNumbers, result.DisplacementLengths) if node in nodes)

    def test_contact_transmits_pressure(self):
        self.mesh()
        self.contact()
        self.analysis.hold("xyz", (0, 5, 5))
        self.analysis.hold("yz", (15, 0, 5), (15, 5, 0))
        self.analysis.press((20, 5, 5), 10)
        result = self.analysis.solve()
        self.assertAlmostEqual(result["reactions"][0], 1000, delta=10)


run_in_freecad.run(Apart, Solved)
