"""Differences of FreeCAD 0.21 and 1.x, with stand-ins for their features. Run by run.py."""

import os
import sys
import types
import unittest
from unittest import mock

import FreeCAD
import ObjectsFem
import Part
from freecad.collarmesh_workbench import (compatibility, mesh_object, mesh_properties, size_objects, take_over,
                                          up_to_date)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


class Versions(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.part = self.document.addObject("Part::Feature", "Part")
        self.part.Shape = Part.makeBox(10, 8, 6)

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def base_of_freecad_1(self, document, name):
        """Returns a stand-in for FreeCAD 1's base: its mesh objects link the part by `Shape`, and regions are
        called refinements."""
        obj = document.addObject("Fem::FemMeshObjectPython", name)
        obj.addProperty("App::PropertyLink", "Shape", "FEM Mesh")
        return obj

    def test_the_part_is_linked_by_shape(self):
        with mock.patch.object(compatibility, "add_mesh_object", self.base_of_freecad_1):
            obj = mesh_object.make(self.document, self.part)
        self.assertNotIn("Part", obj.PropertiesList)
        self.assertEqual((obj.Shape, compatibility.meshed_object(obj)), (self.part, self.part))
        obj.CharacteristicLengthMax = 3
        size_objects.make(obj, "Sphere", 1)
        mesh_object.remesh(obj)
        self.assertGreater(obj.FemMesh.VolumeCount, 50)
        self.assertFalse(up_to_date.is_out_of_date(obj))
        self.part.Shape = Part.makeBox(10, 8, 7)
        self.assertTrue(up_to_date.is_out_of_date(obj))

    def test_refinements(self):
        """FreeCAD 1.x has only its own function for this."""

        def make(document, base, element_length=0.0, name="MeshRefinement"):
            made.append(document.addObject("App::FeaturePython", name))
            made[0].addProperty("App::PropertyLinkSubListGlobal", "References")
            made[0].addProperty("App::PropertyLength", "CharacteristicLength")
            made[0].CharacteristicLength = element_length
            name = next(each for each in ("MeshRefinementList", "MeshRegionList") if each in base.PropertiesList)
            setattr(base, name, [*getattr(base, name), made[0]])
            return made[0]

        made = []
        obj = mesh_object.make(self.document, self.part)
        with mock.patch.object(compatibility, "ObjectsFem", types.SimpleNamespace(makeMeshRefinement=make)):
            refinement = compatibility.make_refinement(self.document, obj)
        self.assertEqual(([refinement], obj.MeshRegionList), (made, made))
        refinement.References = [(self.part, "Face1")]
        refinement.CharacteristicLength = 0.7
        self.assertEqual(mesh_properties.settings_of(obj).face_sizes, {1: 0.7})

    def test_buttons(self):
        """FreeCAD 1.x asks for the places when it builds its bars, and inserts the commands one after the
        other."""

        class Gui:
            manipulators = []

            @classmethod
            def addWorkbenchManipulator(cls, manipulator):
                cls.manipulators.append(manipulator)

        with mock.patch.dict(sys.modules, {"FreeCADGui": types.ModuleType("FreeCADGui")}):
            self.assertFalse(compatibility.add_to_bars({"Ours": "Theirs"}), "before 1.0")
        with mock.patch.dict(sys.modules, {"FreeCADGui": Gui}):
            self.assertTrue(compatibility.add_to_bars({"First": "Theirs", "Second": "Theirs", "Third": "Others"}))
        (manipulator,) = Gui.manipulators
        bars = {"menuItem": ["Theirs", "Others"], "toolItem": ["Theirs", "Others"]}
        for changes in (manipulator.modifyMenuBar(), manipulator.modifyToolBars()):
            for change in changes:
                kind = next(name for name in bars if name in change)
                at = bars[kind].index(change[kind])  # in a toolbar before its place, in a menu as "after" says
                bars[kind].insert(at + ("after" in change), change["insert"])
        self.assertEqual(bars["menuItem"], ["Theirs", "First", "Second", "Others", "Third"])

    def test_lists_of_refinements(self):
        gmsh = self.document.addObject("Fem::FemMeshObjectPython", "Gmsh")
        gmsh.addProperty("App::PropertyLinkList", "MeshRefinementList")
        self.assertEqual(compatibility.refinements_of(gmsh), [])
        compatibility.set_refinements(gmsh, [self.part])
        self.assertEqual(
            (gmsh.MeshRefinementList, compatibility.refinements_of(gmsh)), ([self.part], [self.part])
        )

    def test_hand_over_to_gmsh_of_freecad_1(self):
        def make(document, name):
            obj = self.base_of_freecad_1(document, name)
            obj.addProperty("App::PropertyLength", "CharacteristicLengthMax")
            obj.addProperty("App::PropertyLinkList", "MeshRefinementList")
            obj.addProperty("App::PropertyLinkList", "MeshGroupList")
            return obj

        obj = mesh_object.make(self.document, self.part)
        obj.CharacteristicLengthMax = 3
        refinement = ObjectsFem.makeMeshRegion(self.document, obj, 1)
        with mock.patch.object(take_over, "ObjectsFem", types.SimpleNamespace(makeMeshGmsh=make)):
            gmsh, _ = take_over.hand_over(obj)
        self.assertEqual((gmsh.Shape, gmsh.MeshRefinementList), (self.part, [refinement]))
        self.assertEqual(gmsh.CharacteristicLengthMax.Value, 3)

    def refinement(self, kind, **properties):
        """Returns a refinement of FreeCAD 1.1."""
        obj = self.document.addObject("App::FeaturePython", kind)
        obj.Proxy = types.SimpleNamespace(Type=f"Fem::{kind}")
        types_of = {"ShapeType": "App::PropertyString", "References": "App::PropertyLinkSubList"}
        for name, value in properties.items():
            length = "App::PropertyVector" if name.endswith("Center") else "App::PropertyLength"
            obj.addProperty(types_of.get(name, length), name)
            setattr(obj, name, value)
        return obj

    def test_sizes_by_place_of_gmsh(self):
        gmsh = ObjectsFem.makeMeshGmsh(self.document)
        gmsh.Part = self.part
        sizes = {"SizeIn": 1, "SizeOut": 4, "Thickness": 6}
        plain = ObjectsFem.makeMeshRegion(self.document, gmsh, 2)
        made = [
            plain,
            self.refinement("MeshShape", ShapeType="Sphere",
                            SphereCenter=FreeCAD.Vector(1, 2, 3), SphereRadius=2, **sizes),
            self.refinement("MeshShape", ShapeType="Box", BoxCenter=FreeCAD.Vector(5, 4, 3), BoxLength=2, BoxWidth=4,
                            BoxHeight=6, **sizes),
            self.refinement("MeshDistance", DistanceMinimum=1, DistanceMaximum=5, SizeMinimum=0.5, SizeMaximum=2.5,
                            References=[(self.part, ("Face1",))]),
            self.refinement("MeshTransfiniteCurve", References=[(self.part, ("Edge1",))]),
        ]
        labels = [each.Label for each in made]
        gmsh.MeshRegionList = made
        ours, notes = take_over.take_over(gmsh)
        self.assertEqual(ours.MeshRegionList, [plain])
        ball, box, near = ours.MeshSizeList
        self.assertEqual([each.Label for each in ours.MeshSizeList], labels[1:4])
        self.assertEqual((ball.Size.Value, ball.Radius.Value, ball.Growth), (1, 2, 0.5))
        self.assertEqual(tuple(ball.Placement.Base), (1, 2, 3))
        self.assertEqual((tuple(box.Placement.Base), box.Width.Value), ((4, 2, 0), 4))
        self.assertEqual((near.Size.Value, near.Within.Value, near.Growth), (0.5, 1, 0.5))
        self.assertEqual(notes, [f"Refinements of Gmsh that collarmesh does not have: {labels[4]}"])
        mesh_object.remesh(ours)
        self.assertGreater(ours.FemMesh.VolumeCount, 50)

    def test_what_is_suppressed_does_not_count(self):
        obj = mesh_object.make(self.document, self.part)
        obj.CharacteristicLengthMax = 4
        region = ObjectsFem.makeMeshRegion(self.document, obj, 0.5)
        region.References = [(self.part, "Face1")]
        sphere = size_objects.make(obj, "Sphere", 0.5)
        group = ObjectsFem.makeMeshGroup(self.document, obj)
        group.References = [(self.part, "Face1")]
        mesh_object.remesh(obj)
        count = obj.FemMesh.VolumeCount
        for each in (region, sphere, group):
            each.addProperty("App::PropertyBool", "Suppressed")
            each.Suppressed = True
            self.assertTrue(up_to_date.is_out_of_date(obj), each.Label)
            mesh_object.remesh(obj)
            self.assertFalse(up_to_date.is_out_of_date(obj), each.Label)
        self.assertLess(obj.FemMesh.VolumeCount, count / 2)
        self.assertNotIn(f"{group.Name}_Faces", [obj.FemMesh.getGroupName(n) for n in obj.FemMesh.Groups])

    def test_proxies_save_nothing(self):
        """FreeCAD 0.20 calls the first pair of methods, later versions the second."""
        proxy = mesh_object.make(self.document, self.part).Proxy
        self.assertEqual((proxy.__getstate__(), proxy.dumps()), (None, None))
        self.assertEqual((proxy.__setstate__(None), proxy.loads(None)), (None, None))

    def test_context_menus_of_other_meshers(self):
        """Netgen's view provider is in Python from FreeCAD 1.0 on; one that has its own menu keeps it."""
        seen = []

        class VPMeshNetgen:
            def setupContextMenu(self, view, menu):
                seen.append("its own")

        class VPMeshGmsh:
            pass

        modules = {
            "femviewprovider.view_mesh_gmsh": types.SimpleNamespace(VPMeshGmsh=VPMeshGmsh),
            "femviewprovider.view_mesh_netgen": types.SimpleNamespace(VPMeshNetgen=VPMeshNetgen),
        }
        with mock.patch.dict(sys.modules, modules):
            compatibility.extend_context_menus(lambda menu, obj: seen.append(obj))
        for provider, expected in ((VPMeshGmsh, [self.part]), (VPMeshNetgen, [self.part, "its own"])):
            seen.clear()
            provider().setupContextMenu(types.SimpleNamespace(Object=self.part), None)
            self.assertEqual(seen, expected)

    def test_missing_view_providers_are_no_error(self):
        with mock.patch.dict(
            sys.modules, {"femviewprovider.view_mesh_gmsh": None, "femviewprovider.view_mesh_netgen": None}
        ):
            compatibility.extend_context_menus(None)

    def test_forces(self):
        """A force is a number in N, in later versions a quantity."""
        self.assertEqual(compatibility.force_of(types.SimpleNamespace(Force=5.0)), 5)
        force = compatibility.force_of(types.SimpleNamespace(Force=FreeCAD.Units.Quantity("5 kN")))
        self.assertEqual(force.Value, 5000)

    def test_transactions(self):
        self.document.UndoMode = 1
        with compatibility.transaction(self.document, "outer"):
            self.part.Label = "A"
            with compatibility.transaction(self.document, "inner"):
                self.part.Label = "B"
        self.document.undo()
        self.assertEqual(self.part.Label, "Part")
        self.document.openTransaction("of a script that does not end it")
        self.part.Label = "D"
        with compatibility.transaction(self.document, "next"):
            self.part.Label = "E"
        self.document.undo()
        self.assertEqual(self.part.Label, "D")
        self.document.undo()
        self.assertEqual(self.part.Label, "Part")
        with self.assertRaises(KeyError), compatibility.transaction(self.document, "fails"):
            self.part.Label = "C"
            raise KeyError
        self.assertEqual(self.part.Label, "Part")


run_in_freecad.run(Versions)
