"""The add-on in FreeCAD's window: buttons, panel, progress, cancel, bad shapes, reopening. Run by run.py --gui."""

import os
import tempfile
import traceback

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore, QtGui

from freecad.collarmesh_workbench import mesh_object, preferences, task_panel
from freecad.collarmesh_workbench.commands import GROUP_COMMAND, MESH_COMMAND, REFINEMENT_COMMAND
from freecad.collarmesh_workbench.fem_buttons import BESIDE

SCREENSHOTS = os.environ.get("COLLARMESH_TEST_ARGUMENT", "")
window = FreeCADGui.getMainWindow()
WIDE = (0, 0, 2600, 1000)  # enough for all buttons of FEM
window.setGeometry(*WIDE)


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def child(name):
    found = window.findChild(QtGui.QWidget, "collarmesh_" + name)
    require(found is not None, f"no widget {name}")
    return found


def wait_until(condition, what, seconds=60):
    """Lets FreeCAD go on until the condition holds."""
    clock = QtCore.QElapsedTimer()
    clock.start()
    while not condition():
        QtGui.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)
        require(clock.elapsed() < 1000 * seconds, f"waited too long for {what}")


def screenshot(name):
    """A picture of the window, made small for it, with all of the mesh in view."""
    if not SCREENSHOTS:
        return
    clock = QtCore.QElapsedTimer()
    window.setGeometry(0, 0, 1200, 900)
    for _ in range(2):
        clock.start()
        wait_until(lambda: clock.elapsed() > 400, "the picture")
        FreeCADGui.SendMsgToActiveView("ViewFit")
    clock.start()
    wait_until(lambda: clock.elapsed() > 400, "the picture")
    QtGui.QApplication.primaryScreen().grabWindow(0).copy(0, 0, 1200, 900).save(os.path.join(SCREENSHOTS, name))
    window.setGeometry(*WIDE)


def bars_with(command):
    """The kinds of bars that show a command right after FreeCAD's button that it belongs to."""
    found = set()
    for bar in window.findChildren(QtGui.QToolBar) + window.findChildren(QtGui.QMenu):
        names = [action.objectName() for action in bar.actions()]
        if command in names and names.index(command) == names.index(BESIDE[command]) + 1:
            found.add(type(bar).__name__)
    return found


def click(command):
    """The command's button in the toolbar."""
    next(button for bar in window.findChildren(QtGui.QToolBar) for button in bar.findChildren(QtGui.QToolButton)
         if button.defaultAction() is not None and button.defaultAction().objectName() == command).click()  # fmt: skip


def run_mesher(size):
    """Click "Mesh" and wait for the end; returns what the panel says."""
    child("CharacteristicLengthMax").setText(size)
    child("run").click()
    wait_until(lambda: child("run").isEnabled(), "the end of the run")
    return child("log").toPlainText()


def plate():
    return Part.makeBox(40, 30, 5).cut(Part.makeCylinder(6, 7, FreeCAD.Vector(20, 15, -1)))


def buttons_are_in_fem():
    FreeCADGui.activateWorkbench("PartWorkbench")
    FreeCADGui.activateWorkbench("FemWorkbench")
    for command in BESIDE:
        wait_until(lambda: bars_with(command) == {"QToolBar", "QMenu"}, f"{command} in the toolbar and the menu")


def click_opens_the_panel(document, part):
    FreeCADGui.Selection.addSelection(part)
    click(MESH_COMMAND)
    wait_until(lambda: window.findChild(QtGui.QWidget, "collarmesh_run") is not None, "the panel")
    obj = document.getObject("FEMMeshCollarmesh")
    require(obj is not None and obj.Part is part, "the object links its part")
    return obj


def progress_moves_and_the_mesh_shows(obj, part):
    seen = set()
    child("progress").valueChanged.connect(seen.add)
    said = run_mesher("2 mm")
    require(obj.FemMesh.VolumeCount > 1000, said)
    require(len(seen) > 3 and max(seen) == 1000, f"progress moves: {sorted(seen)}")
    require("every guarantee holds" in said and "dihedral angles" in said, said)
    part.ViewObject.Visibility = False
    require(obj.ViewObject.Visibility, "the mesh shows")
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    screenshot("freecad_panel.png")


def worst_elements_show(obj):
    def shown():
        return obj.ViewObject.RootNode.getByName("collarmesh_worst_elements") is not None

    require(not shown(), "no highlight at first")
    child("worst").setChecked(True)
    require(shown() and "worst elements" in child("log").toPlainText(), child("log").toPlainText())
    screenshot("freecad_worst_elements.png")
    child("worst").setChecked(False)
    require(not shown(), "the highlight ends")


def cancel_keeps_the_mesh(obj):
    count = obj.FemMesh.VolumeCount
    child("CharacteristicLengthMax").setText("0.15 mm")
    child("run").click()
    require(child("cancel").isEnabled(), "cancel is possible")
    wait_until(lambda: child("progress").value() > 70, "a long run")
    clock = QtCore.QElapsedTimer()
    clock.start()
    child("cancel").click()
    wait_until(lambda: child("run").isEnabled(), "the end of the cancelled run")
    require(clock.elapsed() < 3000, "cancel is quick")
    require(obj.FemMesh.VolumeCount == count, "cancel keeps the mesh")


def bad_shapes_are_told(obj, part):
    count, program = obj.FemMesh.VolumeCount, os.environ["COLLARMESH_PROGRAM"]
    box = Part.makeBox(10, 10, 10)
    shapes = (
        ("a sheet", Part.Shell(box.Faces[:1]), ("no solid", "Edge", "Face", "(")),
        ("null", Part.Shape(), ("no shape", "Plate")),
    )
    for name, shape, words in shapes:
        part.Shape = shape
        said = run_mesher("2 mm")
        for word in words:
            require(word in said, f"{name}: {word} is not in: {said}")
        require(obj.FemMesh.VolumeCount == count, f"{name} keeps the mesh")
        if name == "a sheet":
            screenshot("freecad_message.png")
    os.environ["COLLARMESH_PROGRAM"] = "/no/such/program"
    part.Shape = box
    said = run_mesher("2 mm")
    require("/no/such/program" in said and "preferences" in said, said)
    os.environ["COLLARMESH_PROGRAM"] = program
    said = run_mesher("nonsense")
    require("no value" in said, said)
    require(obj.FemMesh.VolumeCount == count, "the mesh is kept")
    step = [FreeCAD.Vector(*p) for p in ((0, 0, 0), (9, 0, 0), (10, 0.005, 0), (10, 0.01, 0), (0, 10, 0), (0, 0, 0))]
    part.Shape = Part.Face(Part.makePolygon(step)).extrude(FreeCAD.Vector(0, 0, 2))
    said = run_mesher("2 mm")
    require("0.005 mm" in said and "Edge" in said and "(10, 0.0075, " in said, said)


def overlaps_and_repairs_are_told(obj, part):
    """What was done to the shape, and where, stands in the panel."""
    box = Part.makeBox(10, 10, 10)
    part.Shape = Part.makeCompound([box, Part.makeBox(10, 10, 10, FreeCAD.Vector(6, 0, 0))])
    said = run_mesher("3 mm")
    require("warning: the shape: Solid1 and Solid2 overlap around (8, 5, 5)" in said and "400" in said, said)
    require("every guarantee holds" in said, said)
    part.Shape = Part.Shell(box.Faces[:5])
    said = run_mesher("3 mm")
    require("warning: the shape was repaired: " in said and "hole" in said and "(" in said, said)
    require("every guarantee holds" in said, said)
    screenshot("freecad_repair.png")


def nodes_off_their_faces_are_told(document):
    """With the face: the panel's summary has what the program reports."""
    ring = document.addObject("Part::Feature", "Ring")
    ring.Shape = Part.makeTorus(10, 3)
    obj = mesh_object.make(document, ring)
    obj.CharacteristicLengthMax, obj.ElementOrder = 2.7, "2nd"
    report = mesh_object.remesh(obj)
    off = report["second_order"]["straightened"]
    require(("nodes amid edges stay off" in task_panel.summary(report)) == bool(off), task_panel.summary(report))
    report["second_order"]["straightened"] = [{"dimension": 2, "tag": 1}]
    require("1 nodes amid edges stay off the exact shape, at Face1" in task_panel.summary(report), "the face is named")
    document.removeObject(obj.Name)
    document.removeObject(ring.Name)


def refinements_and_groups(document, obj, part):
    """Their buttons, and what they do to the mesh."""
    part.Shape = plate()
    obj.CharacteristicLengthMax = 4
    for command in (REFINEMENT_COMMAND, GROUP_COMMAND):
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(obj)
        click(command)
        wait_until(lambda: FreeCADGui.ActiveDocument.getInEdit() is not None, "its panel")
        FreeCADGui.Control.closeDialog()
        FreeCADGui.ActiveDocument.resetEdit()
    refinement, group = obj.MeshRegionList[0], obj.MeshGroupList[0]
    refinement.CharacteristicLength = 0.8
    refinement.References = group.References = [(part, "Face1")]
    FreeCADGui.ActiveDocument.setEdit(obj.Name)
    said = run_mesher("4 mm")
    names = {obj.FemMesh.getGroupName(n): n for n in obj.FemMesh.Groups}
    require(f"{group.Name}_Faces" in names, said)
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


def reopening_keeps_everything(document, obj):
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
    FreeCADGui.getDocument(document.Name).setEdit(name)
    wait_until(lambda: window.findChild(QtGui.QWidget, "collarmesh_run") is not None, "the panel after reopening")
    require("every guarantee holds" in run_mesher("4 mm"), "it can be meshed again")
    FreeCADGui.ActiveDocument.resetEdit()
    FreeCAD.closeDocument(document.Name)


def test():
    document = FreeCAD.newDocument("gui")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = plate()
    document.recompute()
    buttons_are_in_fem()
    obj = click_opens_the_panel(document, part)
    progress_moves_and_the_mesh_shows(obj, part)
    worst_elements_show(obj)
    cancel_keeps_the_mesh(obj)
    bad_shapes_are_told(obj, part)
    overlaps_and_repairs_are_told(obj, part)
    FreeCADGui.ActiveDocument.resetEdit()
    nodes_off_their_faces_are_told(document)
    refinements_and_groups(document, obj, part)
    preferences_page_keeps_values()
    reopening_keeps_everything(document, obj)


def main():
    try:
        test()
        said = "passed"
    except BaseException:
        said = traceback.format_exc()
    with open(os.environ["COLLARMESH_TEST_RESULT"], "w", encoding="utf-8") as result:
        result.write(said)
    os._exit(0 if said == "passed" else 1)


QtCore.QTimer.singleShot(1500, main)
