"""Mesh objects of Gmsh and Netgen become ours and ours become Gmsh's; export and statistics. Run by run.py."""

import os
import sys
import tempfile
import unittest
from unittest import mock

import Fem
import FreeCAD
import ObjectsFem
import Part
from femmesh import gmshtools
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import (
    compatibility,
    mesh_file,
    mesh_object,
    mesh_properties,
    mesh_undo,
    size_objects,
    statistics_dialog,
    take_over,
    up_to_date,
)
from freecad.collarmesh_workbench.program import MesherError

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


def group_names(fem_mesh):
    return {fem_mesh.getGroupName(number) for number in fem_mesh.Groups}


class WithPart(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")
        self.document.UndoMode = 1
        self.part = self.document.addObject("Part::Feature", "Plate")
        self.part.Shape = Part.makeBox(40, 30, 5).cut(Part.makeCylinder(6, 7, FreeCAD.Vector(20, 15, -1)))
        self.analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def gmsh(self):
        """Makes a Gmsh object with a refinement and a group, in the analysis."""
        obj = ObjectsFem.makeMeshGmsh(self.document, "FromGmsh")
        obj.Part = self.part
        obj.CharacteristicLengthMax, obj.CharacteristicLengthMin = 4, 0.5
        obj.MeshSizeFromCurvature = 16
        obj.ElementOrder = "2nd"
        refinement = ObjectsFem.makeMeshRegion(self.document, obj, 1.0)
        refinement.References = [(self.part, "Face1")]
        group = ObjectsFem.makeMeshGroup(self.document, obj)
        group.References = [(self.part, "Face2")]
        first = ObjectsFem.makeMaterialSolid(self.document, "Steel")
        last = ObjectsFem.makeConstraintFixed(self.document, "Fixed")
        self.analysis.Group = [first, obj, last]
        return obj, refinement, group


class TakeOver(WithPart):
    def test_from_gmsh_with_everything(self):
        old, refinement, group = self.gmsh()
        self.assertFalse(gmshtools.GmshTools(old).create_mesh())
        count, label = old.FemMesh.VolumeCount, "Mesh of the plate"
        old.Label = label
        new, notes = take_over.take_over(old)
        self.assertEqual(notes, [])
        self.assertIsNone(self.document.getObject("FromGmsh"))
        self.assertTrue(mesh_properties.is_ours(new))
        self.assertEqual([each.Name for each in self.analysis.Group], ["Steel", new.Name, "Fixed"])
        self.assertEqual((new.Label, compatibility.meshed_object(new)), (label, self.part))
        self.assertEqual((new.CharacteristicLengthMax.Value, new.CharacteristicLengthMin.Value), (4, 0.5))
        self.assertEqual((new.MeshSizeFromCurvature, new.ElementOrder), (16, "2nd"))
        self.assertEqual((new.MeshRegionList, new.MeshGroupList), ([refinement], [group]))
        self.assertEqual(new.FemMesh.VolumeCount, count)
        self.assertTrue(up_to_date.is_out_of_date(new))
        mesh_object.remesh(new)
        self.assertFalse(up_to_date.is_out_of_date(new))
        self.assertIn(f"{group.Name}_Faces", group_names(new.FemMesh))

    def test_one_step_of_undo(self):
        old, refinement, group = self.gmsh()
        take_over.take_over(old)
        self.document.undo()
        old = self.document.getObject("FromGmsh")
        self.assertEqual(take_over.mesher_of(old), "Gmsh")
        self.assertIn(old, self.analysis.Group)
        self.assertEqual((old.MeshRegionList, old.MeshGroupList), ([refinement], [group]))
        self.assertFalse(any(mesh_properties.is_ours(each) for each in self.document.Objects))
        self.document.redo()
        (new,) = [each for each in self.document.Objects if mesh_properties.is_ours(each)]
        self.assertEqual((new.MeshRegionList, new.MeshGroupList), ([refinement], [group]))
        mesh_object.remesh(new)

    def test_what_gmsh_alone_has_is_told(self):
        old, *_ = self.gmsh()
        old.RecombineAll = True
        layer = ObjectsFem.makeMeshBoundaryLayer(self.document, old)
        _new, notes = take_over.take_over(old)
        self.assertIn("RecombineAll", notes[0])
        self.assertIn(layer.Label, notes[1])
        self.assertIsNotNone(self.document.getObject(layer.Name))

    def test_there_and_back(self):
        old, refinement, group = self.gmsh()
        ours, _ = take_over.take_over(old)
        name = ours.Name
        sphere = size_objects.make(ours, "Sphere", 0.7)
        mesh_object.remesh(ours)
        count = ours.FemMesh.VolumeCount
        gmsh, notes = take_over.hand_over(ours)
        self.assertIn("SizeSphere", notes[0])
        self.assertEqual(take_over.mesher_of(gmsh), "Gmsh")
        self.assertEqual((gmsh.CharacteristicLengthMax.Value, gmsh.CharacteristicLengthMin.Value), (4, 0.5))
        self.assertEqual((gmsh.MeshSizeFromCurvature, gmsh.ElementOrder), (16, "2nd"))
        self.assertEqual(
            (gmsh.Part, gmsh.MeshRegionList, gmsh.MeshGroupList), (self.part, [refinement], [group])
        )
        self.assertEqual(gmsh.FemMesh.VolumeCount, count)
        self.assertIn(gmsh, self.analysis.Group)
        self.assertFalse(gmshtools.GmshTools(gmsh).create_mesh())
        made_by_gmsh = gmsh.FemMesh.VolumeCount
        self.assertNotEqual(made_by_gmsh, count)
        again, _ = take_over.take_over(gmsh)
        self.assertEqual(again.MeshSizeList, [sphere])
        self.assertEqual(again.Name, name, "the name of the one before, but not its meshes")
        mesh_object.remesh(again)
        self.assertNotEqual(again.FemMesh.VolumeCount, made_by_gmsh)
        self.document.undo()
        self.assertEqual(again.FemMesh.VolumeCount, made_by_gmsh)

    def test_from_netgen(self):
        """Debian's FreeCAD has Netgen's object, but cannot run it."""
        old = ObjectsFem.makeMeshNetgen(self.document, "FromNetgen")
        old.Shape = self.part
        old.MaxSize, old.SecondOrder, old.Fineness = 3, True, "Fine"
        self.analysis.addObject(old)
        new, _ = take_over.take_over(old)
        self.assertEqual((new.CharacteristicLengthMax.Value, new.ElementOrder), (3, "2nd"))
        self.assertEqual(compatibility.meshed_object(new), self.part)
        self.assertAlmostEqual(new.Gradation, 0.2)
        self.assertEqual(new.MeshSizeFromCurvature, 19)  # 3 elements per radius
        self.assertEqual(self.analysis.Group, [new])
        mesh_object.remesh(new)

    def test_from_netgen_with_its_own_sizes(self):
        old = ObjectsFem.makeMeshNetgen(self.document, "FromNetgen")
        old.Shape = self.part
        old.Fineness, old.GrowthRate, old.NbSegsPerRadius = "UserDefined", 0.4, 1
        new, _ = take_over.take_over(old)
        self.assertEqual(new.CharacteristicLengthMax.Value, 0)  # Netgen's default of 1000 mm means no size
        self.assertAlmostEqual(new.Gradation, 0.4)
        self.assertEqual(new.MeshSizeFromCurvature, 6)

    def test_netgen_of_freecad_1(self):
        """Uses a stand-in with the properties of the object in FreeCAD 1."""
        old = self.document.addObject("Fem::FemMeshObjectPython", "FromNetgen")
        for kind, name, value in (
            ("App::PropertyLink", "Shape", self.part), ("App::PropertyLength",
                                                        "MaxSize", 3), ("App::PropertyLength", "MinSize", 0.2),
            ("App::PropertyBool", "SecondOrder", True), ("App::PropertyFloat", "GrowthRate", 0.3),
            ("App::PropertyFloat", "CurvatureSafety", 2), ("App::PropertyLinkList", "MeshRefinementList", []),
        ):
            old.addProperty(kind, name)
            setattr(old, name, value)
        old.addProperty("App::PropertyEnumeration", "Fineness")
        old.Fineness = ["UserDefined", "Fine"]

        class Proxy:
            Type = "Fem::FemMeshNetgen"

        old.Proxy = Proxy()
        refinement = ObjectsFem.makeMeshRegion(self.document, ObjectsFem.makeMeshGmsh(self.document, "Other"))
        old.MeshRefinementList = [refinement]
        new, _ = take_over.take_over(old)
        self.assertEqual(new.CharacteristicLengthMin.Value, 0.2)
        self.assertAlmostEqual(new.Gradation, 0.3)
        self.assertEqual(new.MeshSizeFromCurvature, 13)
        self.assertEqual(new.MeshRegionList, [refinement])

    def test_other_objects_are_refused(self):
        with self.assertRaisesRegex(MesherError, "Plate is no mesh of Gmsh or Netgen"):
            take_over.take_over(self.part)
        self.assertEqual([each.Name for each in self.document.Objects], ["Plate", "Analysis"])


class TwoMeshes(WithPart):
    def test_in_one_analysis(self):
        """Each object has its own sizes, state and undo."""
        material = ObjectsFem.makeMaterialSolid(self.document, "Steel")
        self.analysis.addObject(material)
        first, second = (
            collarmesh_workbench.mesh(self.part, analysis=self.analysis, size=size) for size in (6, 4)
        )
        size_objects.make(second, "Sphere", 1)
        self.assertEqual(first.MeshSizeList, [])
        self.document.recompute()
        self.assertFalse(up_to_date.is_out_of_date(first))
        self.assertTrue(up_to_date.is_out_of_date(second))
        counts = first.FemMesh.VolumeCount, second.FemMesh.VolumeCount
        mesh_object.remesh(second)
        self.assertNotEqual(second.FemMesh.VolumeCount, counts[1])
        self.document.undo()
        self.assertEqual((first.FemMesh.VolumeCount, second.FemMesh.VolumeCount), counts)
        first.CharacteristicLengthMax = 3
        mesh_object.remesh(first)
        self.assertEqual(second.FemMesh.VolumeCount, counts[1])
        self.document.undo()
        self.assertEqual((first.FemMesh.VolumeCount, second.FemMesh.VolumeCount), counts)
        self.document.removeObject(first.Name)
        self.assertEqual(second.FemMesh.VolumeCount, counts[1])
        mesh_object.remesh(second)


class Undo(WithPart):
    def test_many_meshings(self):
        """Makes more meshes than are kept: the last ones can be undone, earlier ones stay as they are."""
        obj = mesh_object.make(self.document, self.part)
        counts = []
        with mock.patch.object(mesh_undo, "KEPT", 3):
            for size in (8, 6, 5, 4, 3):
                obj.CharacteristicLengthMax = size
                mesh_object.remesh(obj)
                counts.append(obj.FemMesh.VolumeCount)
        self.assertEqual(counts, sorted(set(counts)))
        for count in counts[-2:-4:-1]:
            self.document.undo()
            self.assertEqual(obj.FemMesh.VolumeCount, count)
        for count in counts[-2:]:
            self.document.redo()
            self.assertEqual(obj.FemMesh.VolumeCount, count)
        with mock.patch.object(mesh_undo, "NODES", 1):
            mesh_object.remesh(obj)
        self.document.undo()
        self.assertEqual(obj.FemMesh.VolumeCount, counts[-1])

    def test_a_cleared_mesh_stays_cleared(self):
        """Clears the mesh by "Clear FEM mesh" in FreeCAD's menu, and then undoes something else."""
        obj = mesh_object.make(self.document, self.part)
        obj.CharacteristicLengthMax = 8
        mesh_object.remesh(obj)
        counts = [obj.FemMesh.VolumeCount]
        obj.FemMesh = Fem.FemMesh()
        with compatibility.transaction(self.document, "something else"):
            self.part.Label = "Other"
        self.document.undo()
        self.assertEqual(obj.FemMesh.VolumeCount, 0)
        obj.CharacteristicLengthMax = 5
        mesh_object.remesh(obj)
        counts.append(obj.FemMesh.VolumeCount)
        self.document.undo()
        self.assertEqual(obj.FemMesh.VolumeCount, 0, "what the meshing replaced")
        self.document.redo()
        self.assertEqual(obj.FemMesh.VolumeCount, counts[1])

    def test_a_mesh_after_undo_has_a_number_of_its_own(self):
        obj = mesh_object.make(self.document, self.part)
        counts, numbers = [], []
        for size in (8, 6, 4):
            obj.CharacteristicLengthMax = size
            mesh_object.remesh(obj)
            counts.append(obj.FemMesh.VolumeCount)
            numbers.append(obj.MeshNumber)
            if size == 6:
                self.document.undo()
                self.assertEqual((obj.FemMesh.VolumeCount, obj.MeshNumber), (counts[0], numbers[0]))
        self.assertEqual(len(set(numbers)), 3)
        self.document.undo()
        self.assertEqual(obj.FemMesh.VolumeCount, counts[0])
        self.document.redo()
        self.assertEqual(obj.FemMesh.VolumeCount, counts[2])


class Files(WithPart):
    def setUp(self):
        super().setUp()
        self.obj = collarmesh_workbench.mesh(self.part, size=3, order=2)

    def test_export_with_names(self):
        with tempfile.TemporaryDirectory() as folder:
            for extension, words in ((".msh", (b'"Face1"', b'"Edge1"', b'"Solid1"')),
                                     (".inp", (b"FACE1", b"C3D10", b"SOLID1")), (".unv", (b"Face1", b"Solid1")),
                                     (".stl", (b"STL",))):
                path = os.path.join(folder, "plate" + extension)
                mesh_file.export(self.obj, path)
                with open(path, "rb") as file:
                    text = file.read()
                for word in words:
                    self.assertTrue(word in text, f"{extension}: {word}")
                self.assertGreater(len(text), 1000)
            with open(os.path.join(folder, "plate.stl"), "rb") as file:
                triangles = (len(file.read()) - 84) / 50  # binary: a header, then 50 bytes per triangle
            self.assertEqual(triangles, self.obj.FemMesh.FaceCount)

    def test_what_cannot_be_exported_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(MesherError, "nonsense"):
                mesh_file.export(self.obj, os.path.join(folder, "plate.nonsense"))
            with self.assertRaisesRegex(MesherError, "Empty has no mesh yet"):
                empty = mesh_object.make(self.document, self.part, "Empty")
                mesh_file.export(empty, os.path.join(folder, "plate.msh"))
            self.assertEqual(os.listdir(folder), [])

    def test_statistics(self):
        found = mesh_file.statistics(self.obj)
        self.assertEqual(
            (found["tets"], found["points"]), (self.obj.FemMesh.VolumeCount, self.obj.FemMesh.NodeCount)
        )
        self.assertAlmostEqual(sum(found["region_volumes"].values()) / self.part.Shape.Volume, 1, delta=0.01)
        self.assertGreater(found["min_dihedral"], 5)
        page = statistics_dialog.page(self.obj)
        for word in (str(found["tets"]), str(self.obj.FemMesh.NodeCount), "Face7", "Solid1"):
            self.assertIn(word, page)


run_in_freecad.run(TakeOver, TwoMeshes, Undo, Files)
