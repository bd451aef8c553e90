"""The add-on in FreeCAD's window: buttons, panel, progress, cancel, bad shapes, reopening. Run by run.py --gui."""

import os
import sys
import tempfile

import FreeCAD
import FreeCADGui
import Part
from PySide import QtGui

from freecad.collarmesh_workbench import mesh_object, preferences
from freecad.collarmesh_workbench.commands import GROUP_COMMAND, MESH_COMMAND, REFINEMENT_COMMAND
from freecad.collarmesh_workbench.fem_buttons import BESIDE

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from window import (child, click, click_command, open_panel, plate, require, run_mesher, run_test, said,  # noqa: E402
                    screenshot, wait_until, window)


def bars_with(command):
    """Returns the kinds of bars that show a command right after FreeCAD's button to which it belongs."""
    found = set()
    for bar in window.findChildren(QtGui.QToolBar) + window.findChildren(QtGui.QMenu):
        names = [action.objectName() for action in bar.actions()]
        if command in names and names.index(command) == names.index(BESIDE[command]) + 1:
            found.add(type(bar).__name__)
    return found


async def buttons_are_in_fem():
    FreeCADGui.activateWorkbench("PartWorkbench")
    FreeCADGui.activateWorkbench("FemWorkbench")
    for command in BESIDE:
        await wait_until(lambda: bars_with(command) == {"QToolBar", "QMenu"}, f"{command} in the toolbar and the menu")


async def click_opens_the_panel(document, part):
    FreeCADGui.Selection.addSelection(part)
    await click_command(MESH_COMMAND)
    await wait_until(lambda: window.findChild(QtGui.QWidget, "collarmesh_run") is not None, "the panel")
    obj = document.getObject("FEMMeshCollarmesh")
    require(obj is not None and obj.Part is part, "the object links its part")
    return obj


async def progress_moves_and_the_mesh_shows(obj, part):
    seen = set()
    child("progress").valueChanged.connect(seen.add)
    told = await run_mesher("2 mm")
    require(obj.FemMesh.VolumeCount > 1000, told)
    require(len(seen) > 3 and max(seen) > 900, f"progress moves: {sorted(seen)}")
    require("Every guarantee holds" in told and "dihedral angles" in told, told)
    require(obj.ViewObject.Visibility and not part.ViewObject.Visibility, "the mesh shows in place of the part")
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    await screenshot("freecad_panel.png")


async def cancel_keeps_the_mesh(obj):
    count = obj.FemMesh.VolumeCount
    child("CharacteristicLengthMax").setText("0.25 mm")
    await click(child("run"))
    require(child("cancel").isEnabled(), "cancel is possible")
    await wait_until(lambda: child("progress").value() > 70, "a long run")
    await click(child("cancel"))
    await wait_until(lambda: child("run").isEnabled(), "the end of the cancelled run")
    require(obj.FemMesh.VolumeCount == count, "cancel keeps the mesh")


async def bad_shapes_are_told(obj, part):
    count, program = obj.FemMesh.VolumeCount, os.environ["COLLARMESH_PROGRAM"]
    box = Part.makeBox(10, 10, 10)
    shapes = (
        ("a sheet", Part.Shell(box.Faces[:1]), ("Plate is a face", "no volume", "Dimension of the elements")),
        ("null", Part.Shape(), ("no shape", "Plate")),
    )
    child("ElementDimension").setCurrentIndex(3)
    for name, shape, words in shapes:
        part.Shape = shape
        told = await run_mesher("2 mm")
        for word in words:
            require(word in told, f"{name}: {word} is not in: {told}")
        require(obj.FemMesh.VolumeCount == count, f"{name} keeps the mesh")
        if name == "a sheet":
            await screenshot("freecad_message.png")
    os.environ["COLLARMESH_PROGRAM"] = "/no/such/program"
    part.Shape = box
    told = await run_mesher("2 mm")
    require("/no/such/program" in told and "preferences" in told, told)
    os.environ["COLLARMESH_PROGRAM"] = program
    told = await run_mesher("nonsense")
    require("no value" in told, told)
    require(obj.FemMesh.VolumeCount == count, "the mesh is kept")
    step = [FreeCAD.Vector(*p) for p in ((0, 0, 0), (9, 0, 0), (10, 0.005, 0), (10, 0.01, 0), (0, 10, 0), (0, 0, 0))]
    part.Shape = Part.Face(Part.makePolygon(step)).extrude(FreeCAD.Vector(0, 0, 2))
    told = await run_mesher("2 mm")
    require("0.005 mm" in told and "Edge" in told and "(10, 0.0075, " in told, told)


async def refinements_and_groups(document, obj, part):
    """Tests the buttons of refinements and groups, and their effect on the mesh."""
    part.Shape = plate()
    obj.CharacteristicLengthMax = 4
    for command in (REFINEMENT_COMMAND, GROUP_COMMAND):
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(obj)
        await click_command(command)
        await wait_until(lambda: FreeCADGui.ActiveDocument.getInEdit() is not None, "its panel")
        FreeCADGui.Control.closeDialog()
        FreeCADGui.ActiveDocument.resetEdit()
    refinement, group = obj.MeshRegionList[0], obj.MeshGroupList[0]
    refinement.CharacteristicLength = 0.8
    refinement.References = group.References = [(part, "Face1")]
    FreeCADGui.ActiveDocument.setEdit(obj.Name)
    told = await run_mesher("4 mm")
    names = {obj.FemMesh.getGroupName(n): n for n in obj.FemMesh.Groups}
    require(f"{group.Name}_Faces" in names, told)
    elements = obj.FemMesh.getGroupElements(names[f"{group.Name}_Faces"])
    require(set(elements) == set(obj.FemMesh.getFacesByFace(part.Shape.Face1)), "the group holds the face")
    require(len(elements) > 200, "the refinement refines")
    FreeCADGui.ActiveDocument.resetEdit()


def preferences_page_keeps_values():
    page = preferences.Page()
    page.program.setText("/usr/bin/true")
    page.improve.setCurrentIndex(3)
    page.threads.setValue(3)
    page.saveSettings()
    again = preferences.Page()
    again.loadSettings()
    require(preferences.program() == "/usr/bin/true" and again.program.text() == "/usr/bin/true", "the path is kept")
    require(preferences.improve_level() == again.improve.currentIndex() == 3, "the level is kept")
    require(preferences.threads() == again.threads.value() == 3, "the number of threads is kept")
    page.threads.setValue(0)
    page.program.setText("")
    page.improve.setCurrentIndex(2)
    page.saveSettings()


async def reopening_keeps_everything(document, obj):
    name, count, size = obj.Name, obj.FemMesh.VolumeCount, obj.CharacteristicLengthMax.Value
    groups = {obj.FemMesh.getGroupName(n): len(obj.FemMesh.getGroupElements(n)) for n in obj.FemMesh.Groups}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plate.FCStd")
        document.saveAs(path)
        FreeCAD.closeDocument(document.Name)
        document = FreeCAD.openDocument(path)
    obj = document.getObject(name)
    require(obj.FemMesh.VolumeCount == count and obj.CharacteristicLengthMax.Value == size, "mesh and size are kept")
    again = {obj.FemMesh.getGroupName(n): len(obj.FemMesh.getGroupElements(n)) for n in obj.FemMesh.Groups}
    require(again == groups, "groups are kept")
    require(len(obj.MeshRegionList) == len(obj.MeshGroupList) == 1, "refinement and group are kept")
    await open_panel(obj)
    require("Worst elements" in said(), "what the mesh itself tells")
    require("Every guarantee holds" in await run_mesher("4 mm"), "it can be meshed again")
    FreeCADGui.ActiveDocument.resetEdit()
    FreeCAD.closeDocument(document.Name)


async def test():
    document = FreeCAD.newDocument("gui")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = plate()
    document.recompute()
    await buttons_are_in_fem()
    obj = await click_opens_the_panel(document, part)
    await progress_moves_and_the_mesh_shows(obj, part)
    await cancel_keeps_the_mesh(obj)
    await bad_shapes_are_told(obj, part)
    FreeCADGui.ActiveDocument.resetEdit()
    await refinements_and_groups(document, obj, part)
    preferences_page_keeps_values()
    await reopening_keeps_everything(document, obj)


run_test(test)
