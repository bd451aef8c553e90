"""The add-on in FreeCAD's window: button, panel, progress, cancel, result. Run by run.py --gui."""

import os
import traceback

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore, QtGui

from freecad.collarmesh_workbench.commands import MESH_COMMAND

SCREENSHOTS = os.environ.get("COLLARMESH_TEST_ARGUMENT", "")
window = FreeCADGui.getMainWindow()
window.setGeometry(0, 0, 2600, 1000)


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
    if SCREENSHOTS:
        QtGui.QApplication.processEvents()
        window.grab().save(os.path.join(SCREENSHOTS, name))


def actions():
    """Our action in FEM's bars: the kinds of bars that show it right after the Gmsh button."""
    found = set()
    for bar in window.findChildren(QtGui.QToolBar) + window.findChildren(QtGui.QMenu):
        names = [action.objectName() for action in bar.actions()]
        if MESH_COMMAND in names and names.index(MESH_COMMAND) == names.index("FEM_MeshGmshFromShape") + 1:
            found.add(type(bar).__name__)
    return found


def test():
    document = FreeCAD.newDocument("gui")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = Part.makeBox(40, 30, 5).cut(Part.makeCylinder(6, 7, FreeCAD.Vector(20, 15, -1)))
    document.recompute()
    FreeCADGui.activateWorkbench("PartWorkbench")
    FreeCADGui.activateWorkbench("FemWorkbench")
    wait_until(lambda: actions() == {"QToolBar", "QMenu"}, "the button in the toolbar and the menu")

    FreeCADGui.Selection.addSelection(part)
    button = next(b for bar in window.findChildren(QtGui.QToolBar) for b in bar.findChildren(QtGui.QToolButton)
                  if b.defaultAction() is not None and b.defaultAction().objectName() == MESH_COMMAND)  # fmt: skip
    button.click()
    wait_until(lambda: window.findChild(QtGui.QWidget, "collarmesh_run") is not None, "the panel")
    obj = document.getObject("FEMMeshCollarmesh")
    require(obj is not None and obj.Part is part, "the object links its part")

    child("CharacteristicLengthMax").setText("2 mm")
    seen = set()
    child("progress").valueChanged.connect(seen.add)
    child("run").click()
    require(child("cancel").isEnabled(), "cancel is possible")
    wait_until(lambda: child("run").isEnabled(), "the mesh")
    require(obj.FemMesh.VolumeCount > 1000, child("log").toPlainText())
    require(len(seen) > 3 and max(seen) == 1000, f"progress moves: {sorted(seen)}")
    require("every guarantee holds" in child("log").toPlainText(), child("log").toPlainText())
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    part.ViewObject.Visibility = False
    screenshot("freecad_panel.png")

    count = obj.FemMesh.VolumeCount
    child("CharacteristicLengthMax").setText("0.15 mm")
    child("run").click()
    wait_until(lambda: child("progress").value() > 70, "a long run")
    clock = QtCore.QElapsedTimer()
    clock.start()
    child("cancel").click()
    wait_until(lambda: child("run").isEnabled(), "the end of the cancelled run")
    require(clock.elapsed() < 3000, "cancel is quick")
    require(obj.FemMesh.VolumeCount == count, "cancel keeps the mesh")

    part.Shape = Part.Shell(Part.makeBox(10, 10, 10).Faces[:5])
    child("CharacteristicLengthMax").setText("2 mm")
    child("run").click()
    wait_until(lambda: child("run").isEnabled(), "the refusal")
    require("no solid" in child("log").toPlainText() and "Edge" in child("log").toPlainText(), "the fault is told")
    require(obj.FemMesh.VolumeCount == count, "failure keeps the mesh")
    child("CharacteristicLengthMax").setText("nonsense")
    child("run").click()
    require("no value" in child("log").toPlainText(), child("log").toPlainText())
    FreeCADGui.ActiveDocument.resetEdit()
    FreeCAD.closeDocument(document.Name)


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
