"""The add-on without the GUI: FEM's own look-up agrees with the meshes; refinement; errors. Run by run.py."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import FreeCAD
import ObjectsFem
import Part
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import mesh_object, mesh_properties, prediction, program, work_folder

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


def plate_with_hole():
    return Part.makeBox(40, 30, 5).cut(Part.makeCylinder(6, 7, FreeCAD.Vector(20, 15, -1)))


def filleted():
    box = Part.makeBox(20, 15, 10)
    return box.makeFillet(2, box.Edges)


def two_solids():
    return Part.Compound([Part.makeBox(20, 20, 10), Part.makeBox(8, 8, 8, FreeCAD.Vector(5, 5, 10))])


def group(fem_mesh, name):
    for number in fem_mesh.Groups:
        if fem_mesh.getGroupName(number) == name:
            return fem_mesh.getGroupElements(number)
    return ()


def nodes_of(fem_mesh, elements):
    return {node for element in elements for node in fem_mesh.getElementNodes(element)}


def table_of_options():
    """Returns the program's own table of its options when it meshes, by key."""
    text = subprocess.run([program.find_program(), "--generate", "options"],
                          capture_output=True, text=True, check=True).stdout
    return {option["key"]: option for option in json.loads(text) if "mesh" in option["takers"]}


def options_in(arguments):
    """Returns the keys of the options in a command line."""
    return {word.removeprefix("--").replace("-", "_") for word in arguments if word.startswith("--")}


def volume_in(fem_mesh, name):
    """Returns the volume of the tetrahedra in a group."""
    volume = 0
    for element in group(fem_mesh, name):
        a, b, c, d = (fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:4])
        volume -= (b - a).cross(c - a).dot(d - a) / 6  # FreeCAD's order of nodes
    return volume


class Headless(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("test")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def add(self, shape, name="Part"):
        part = self.document.addObject("Part::Feature", name)
        part.Shape = shape
        return part

    def test_lookup_finds_the_nodes_of_the_groups(self):
        for make in (plate_with_hole, filleted):
            part = self.add(make())
            fem_mesh = collarmesh_workbench.mesh(part, size=3).FemMesh
            self.assertGreater(fem_mesh.VolumeCount, 1000)
            for number, face in enumerate(part.Shape.Faces, 1):
                elements = group(fem_mesh, f"Face{number}")
                with self.subTest(make.__name__, face=number):
                    self.assertGreater(len(elements), 0)
                    self.assertEqual(set(fem_mesh.getNodesByFace(face)), nodes_of(fem_mesh, elements))
                    self.assertEqual(len(fem_mesh.getFacesByFace(face)), len(elements))
            for number, edge in enumerate(part.Shape.Edges, 1):
                elements = group(fem_mesh, f"Edge{number}")
                if elements:
                    found = set(fem_mesh.getNodesByEdge(edge))
                    self.assertEqual(found, nodes_of(fem_mesh, elements), f"{make.__name__}: Edge{number}")
            self.assertEqual(len(group(fem_mesh, "Solid1")), fem_mesh.VolumeCount)

    def test_volumes_are_those_of_the_solids(self):
        shape = two_solids()
        obj = collarmesh_workbench.mesh(self.add(shape), size=3)
        fem_mesh = obj.FemMesh
        for number, solid in enumerate(shape.Solids, 1):
            self.assertAlmostEqual(volume_in(fem_mesh, f"Solid{number}"), solid.Volume, places=6)

    def test_shapes_without_objects_and_names(self):
        obj = collarmesh_workbench.mesh(Part.makeBox(1, 2, 3), document=self.document, size=0.5, name="Cube")
        self.assertEqual(obj.Name, "Cube")
        self.assertTrue(obj.isDerivedFrom("Fem::FemMeshObject"))
        self.assertEqual(obj.CharacteristicLengthMax.Value, 0.5)

    def test_regions_refine(self):
        part = self.add(plate_with_hole())
        obj = mesh_object.make(self.document, part)
        obj.CharacteristicLengthMax = 6
        mesh_object.remesh(obj)
        coarse = len(group(obj.FemMesh, "Face1"))
        region = ObjectsFem.makeMeshRegion(self.document, obj, 1.0)
        region.References = [(part, "Face1")]
        mesh_object.remesh(obj)
        self.assertGreater(len(group(obj.FemMesh, "Face1")), 4 * coarse)

    def test_progress_rises_and_cancels(self):
        obj = mesh_object.make(self.document, self.add(plate_with_hole()))
        obj.CharacteristicLengthMax = 1
        seen = []
        mesh_object.remesh(obj, seen.append)
        self.assertEqual([step.fraction for step in seen], sorted(step.fraction for step in seen))
        self.assertIn("refine", {step.phase for step in seen})
        count = obj.FemMesh.VolumeCount
        for progress, error in (
            (lambda step: step.phase != "refine", program.Cancelled),
            (lambda _step: 1 / 0, ZeroDivisionError),
        ):
            with mock.patch.object(work_folder.WorkFolder, "program_is", autospec=True) as program_is:
                with self.assertRaises(error):
                    mesh_object.remesh(obj, progress)
            process_id, after = (each.args[1] for each in program_is.call_args_list)
            self.assertIsNone(after, "the folder forgets the process, whose number may be another one's later")
            self.assertFalse(os.path.exists(f"/proc/{process_id}"))
            self.assertEqual(obj.FemMesh.VolumeCount, count)

    def test_failures_keep_the_mesh_and_say_why(self):
        part = self.add(Part.makeBox(10, 10, 10))
        obj = collarmesh_workbench.mesh(part, size=4)
        obj.ElementDimension = "3D"
        count = obj.FemMesh.VolumeCount
        sheet = Part.Shell(Part.makeBox(10, 10, 10).Faces[:1])
        for shape, words in (
            (sheet, ("Part", "no volume")),
            (Part.makeLine((0, 0, 0), (1, 0, 0)), ("Part", "edges")),
            (Part.Shape(), ("no shape",)),
        ):
            part.Shape = shape
            with self.assertRaises(program.MesherError) as raised:
                mesh_object.remesh(obj)
            for word in words:
                self.assertIn(word, str(raised.exception))
            self.assertEqual(obj.FemMesh.VolumeCount, count)
            objects = len(self.document.Objects)
            with self.assertRaises(program.MesherError):
                collarmesh_workbench.mesh(part, dimension=3)
            self.assertEqual(len(self.document.Objects), objects)

    def test_what_solids_have_in_common_belongs_to_the_first(self):
        boxes = [Part.makeBox(2, 2, 2), Part.makeBox(2, 2, 2, FreeCAD.Vector(1, 1, 1))]
        obj = mesh_object.make(self.document, self.add(Part.Compound(boxes)))
        report = mesh_object.remesh(obj)
        self.assertAlmostEqual(volume_in(obj.FemMesh, "Solid1"), 8, places=6)
        self.assertAlmostEqual(volume_in(obj.FemMesh, "Solid2"), 7, places=6)
        self.assertTrue(any("Solid1 and Solid2 overlap" in note for note in report["notes"]), report["notes"])

    def test_threads_of_the_preferences_reach_the_program(self):
        obj = mesh_object.make(self.document, self.add(Part.makeBox(10, 10, 10)))
        parameters = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/collarmesh")
        self.assertEqual(mesh_object.remesh(obj)["options"]["threads"], 0)
        parameters.SetInt("Threads", 2)
        try:
            self.assertEqual(mesh_object.remesh(obj)["options"]["threads"], 2)
        finally:
            parameters.RemInt("Threads")

    def test_missing_programs(self):
        with self.assertRaisesRegex(program.MesherError, "/no/such is no program"):
            program.find_program("/no/such")

    def test_second_order_lies_on_curved_faces(self):
        part = self.add(filleted())
        fem_mesh = collarmesh_workbench.mesh(part, size=3, order=2).FemMesh
        self.assertEqual(len(fem_mesh.getElementNodes(fem_mesh.Volumes[0])), 10)
        for number, face in enumerate(part.Shape.Faces, 1):
            elements = group(fem_mesh, f"Face{number}")
            self.assertEqual(set(fem_mesh.getNodesByFace(face)), nodes_of(fem_mesh, elements), f"Face{number}")

    def test_groups_of_materials_follow_them(self):
        part = self.add(two_solids())
        analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")
        materials = [ObjectsFem.makeMaterialSolid(self.document, f"Material{i}") for i in (1, 2)]
        analysis.addObjects(materials)
        materials[0].References = [(part, "Solid1")]
        obj = collarmesh_workbench.mesh(part, size=4, analysis=analysis)
        solids = [set(group(obj.FemMesh, f"Solid{i}")) for i in (1, 2)]
        self.assertEqual([set(group(obj.FemMesh, f"Material{i}_Volumes")) for i in (1, 2)], solids)
        materials[0].References = [(part, "Solid2")]
        self.assertEqual([set(group(obj.FemMesh, f"Material{i}_Volumes")) for i in (1, 2)], solids[::-1])
        self.document.removeObject("Material1")  # the other material is everywhere then, which needs no group
        for i in (1, 2):
            self.assertEqual(group(obj.FemMesh, f"Material{i}_Volumes"), ())

    def test_materials_on_solids_of_other_parts_are_told(self):
        part = self.add(two_solids())
        before = self.add(Part.makeBox(3, 3, 3))
        analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")
        steel, other = (ObjectsFem.makeMaterialSolid(self.document, name) for name in ("Steel", "Other"))
        analysis.addObjects([steel, other])
        steel.References = [(before, "Solid1")]
        other.References = [(part, "Solid1")]
        obj = collarmesh_workbench.mesh(part, size=4, analysis=analysis)
        told = [note for note in mesh_object.remesh(obj)["notes"] if "has no elements" in note]
        self.assertEqual(told, [f"Steel has no elements: {part.Label} has none of its solids ({before.Label}: Solid1); "
                                f"choose solids of {part.Label}."])
        steel.References = [(part, "Solid2")]
        self.assertFalse([note for note in mesh_object.remesh(obj)["notes"] if "has no elements" in note])

    def test_groups_of_deleted_objects_vanish(self):
        part = self.add(Part.makeBox(10, 10, 10))
        obj = collarmesh_workbench.mesh(part, size=4)
        owner = ObjectsFem.makeMeshGroup(self.document, obj, name="Clamped")
        owner.References = [(part, "Face1")]
        mesh_object.remesh(obj)
        self.assertEqual(set(group(obj.FemMesh, "Clamped_Faces")), set(group(obj.FemMesh, "Face1")))
        self.document.removeObject(owner.Name)
        self.assertEqual(group(obj.FemMesh, "Clamped_Faces"), ())
        self.assertGreater(len(group(obj.FemMesh, "Face1")), 0)

    def test_every_property_reaches_the_program(self):
        boxes = [Part.makeBox(10, 10, 10, FreeCAD.Vector(10 * i, 0, 0)) for i in range(2)]
        part = self.add(Part.makeCompound(boxes))
        obj = mesh_object.make(self.document, part)
        values = {
            "CharacteristicLengthMax": 4, "CharacteristicLengthMin": 0.5, "MeshSizeFromCurvature": 12,
            "ElementsAcrossGap": 2, "Gradation": 0.5, "SurfaceDistance": 0.02, "CreaseAngle": 55, "CollarAngle": 155,
            "PlanarTolerance": 2e-6, "WeldTolerance": 2e-9,
            "RepairTolerance": 2e-5, "RadiusEdgeRatio": 1.9, "Coarsen": False, "ImproveLevel": 3,
            "MinDihedralAngle": 25, "Seed": 7, "TimeLimit": 60, "FillHoles": True,
            "KeepApart": True, "SplitFaces": [], "PeriodicFaces": [], "InteriorNode": False,
            "LayersAsTetrahedra": False,
        }
        self.assertEqual(set(values), {name for _, name, *_ in mesh_properties.PROPERTIES})
        # tested elsewhere
        of_their_own = ("FillHoles", "SplitFaces", "PeriodicFaces", "InteriorNode", "LayersAsTetrahedra")
        for name, value in values.items():
            setattr(obj, name, value)
            self.assertNotEqual(obj.getDocumentationOfProperty(name), "")
            self.assertNotEqual(obj.getGroupOfProperty(name), "")
        options = mesh_object.remesh(obj)["options"]
        self.assertEqual(obj.FemMesh.VolumeCount > 0, True)
        for _, name, field, *_ in mesh_properties.PROPERTIES:
            if name not in of_their_own:
                self.assertEqual(options[field], values[name], name)

    def test_options_are_those_of_the_program(self):
        table = table_of_options()
        numbers = {field.name: field for field in program.Settings.numbers()}
        self.assertLessEqual(set(numbers), set(table))
        self.assertLessEqual(options_in(prediction.COUNTING), set(table))
        for name, value in (("radius_edge", 2), ("crease_angle", 60), ("collar_angle", 150)):
            self.assertEqual((numbers[name].default, table[name]["default"]), (value, value), name)
        every = program.Settings(
            **{name: 7 for name in numbers}, coarsen=False, dimension=2, repair="wrap", keep_apart=True,
            interior_node=True, layers=["all"], layers_tets=True, split=["Face1"], periodic=["x"],
            solid_sizes={1: 2}, face_sizes={3: 4}, edge_sizes={5: 6})
        self.assertLessEqual(options_in(every.arguments()), set(table))
        self.assertLessEqual(set(numbers), options_in(every.arguments()))

    def test_sides_of_a_sheet_have_their_own_nodes(self):
        sheet = Part.makePlane(4, 4, FreeCAD.Vector(3, 3, 5))
        part = self.add(Part.makeCompound([Part.makeBox(10, 10, 10), sheet]))
        inside = []
        for split in ([], ["Face7"]):
            nodes = collarmesh_workbench.mesh(part, size=2, order=1, split=split).FemMesh.Nodes.values()
            on_sheet = [(round(p.x, 9), round(p.y, 9)) for p in nodes if abs(p.z - 5) < 1e-9]
            inside.append([p for p in on_sheet if all(3.001 < x < 6.999 for x in p)])
        for each in inside[1]:
            self.assertEqual(inside[1].count(each), 2, each)
        self.assertEqual(len(inside[1]), 2 * len(inside[0]))
        self.assertGreater(len(inside[0]), 0)

    def test_each_element_has_a_node_inside(self):
        plate = self.add(Part.makeBox(10, 10, 1))
        for asked in (False, True):
            mesh = collarmesh_workbench.mesh(plate, size=4, order=1, interior_node=asked).FemMesh
            inside = {n for n, p in mesh.Nodes.items() if 0 < p.x < 10 and 0 < p.y < 10 and 0 < p.z < 1}
            self.assertEqual(all(inside & set(mesh.getElementNodes(v)) for v in mesh.Volumes), asked)

    def test_opposite_faces_have_the_same_nodes(self):
        obj = collarmesh_workbench.mesh(self.add(Part.makeBox(10, 10, 10)), size=4, periodic=["x", "Face3=Face4"])
        self.assertEqual(obj.PeriodicFaces, ["x", "Face3=Face4"])
        places = [tuple(round(c, 9) for c in (p.x, p.y, p.z)) for p in obj.FemMesh.Nodes.values()]
        for axis in range(2):
            low, high = ({p[:axis] + p[axis + 1:] for p in places if p[axis] == end} for end in (0, 10))
            self.assertEqual(low, high)
            self.assertGreater(len(low), 20)

    def test_kinds_of_repair_reach_the_program(self):
        obj = collarmesh_workbench.mesh(self.add(Part.makeBox(10, 10, 10)), size=4, repair="none")
        self.assertEqual(obj.Repair, "None")
        for kind, word in mesh_properties.REPAIRS.items():
            obj.Repair = kind
            report = mesh_object.remesh(obj)
            self.assertEqual(report["options"]["repair"], word)
            self.assertFalse(report["repair"]["repaired"])

    def test_repairs_are_warnings(self):
        """Messages of the program become warnings, as the panel and the report view show them."""
        lines = ["repaired: a hole filled at (1, 2, 3)", "warning: a point lies outside", "stage: done"]
        self.assertEqual([program.as_warning(line) for line in lines],
                         ["warning: the shape was repaired: a hole filled at (1, 2, 3)", lines[1], None])

    def test_save_and_reopen(self):
        obj = collarmesh_workbench.mesh(self.add(plate_with_hole()), size=4)
        obj.RadiusEdgeRatio = 1.9
        obj.WeldTolerance = 2e-9
        count, name = obj.FemMesh.VolumeCount, obj.Name
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "plate.FCStd")
            self.document.saveAs(path)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(path)
        obj = self.document.getObject(name)
        self.assertEqual(obj.FemMesh.VolumeCount, count)
        self.assertEqual(obj.RadiusEdgeRatio, 1.9)
        self.assertEqual(obj.WeldTolerance, 2e-9)
        self.assertEqual(obj.Proxy.Type, "Fem::FemMeshCollarmesh")
        mesh_object.remesh(obj)


run_in_freecad.run(Headless)
