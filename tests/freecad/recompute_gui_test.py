"""The program and buttons wait while a document is being recomputed, when FreeCAD's progress bar lets timers
run. Run by run.py --gui."""

import os
import sys

import FreeCAD
import FreeCADGui
from PySide import QtCore

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import meshing_process, mesh_object  # noqa: E402

AFTER = 500  # milliseconds


class SlowObject:
    """An object whose recompute lets timers run until a condition holds, and some time after that."""

    def __init__(self, obj, condition):
        obj.Proxy = self
        self.condition = condition
        self.seen = []

    def execute(self, obj):
        clock, loop = QtCore.QElapsedTimer(), QtCore.QEventLoop()
        clock.start()
        while not self.condition() and clock.elapsed() < 60000:
            loop.processEvents(QtCore.QEventLoop.AllEvents, 50)
        QtCore.QTimer.singleShot(AFTER, loop.quit)
        loop.exec_()
        self.seen.append([(each.Name, getattr(each, "FemMesh", None) and each.FemMesh.NodeCount)
                          for each in obj.Document.Objects])


def slow_object(document, condition):
    slow = document.addObject("App::FeaturePython", "Slow")
    return slow, SlowObject(slow, condition)


async def a_run_ends(document, obj):
    """The mesh is put in place afterwards."""
    await w.open_panel(obj)
    w.child("CharacteristicLengthMax").setText("6 mm")
    await w.click(w.child("run"))
    run = meshing_process.run_of(obj)
    slow, proxy = slow_object(document, lambda: run._process.state() == QtCore.QProcess.NotRunning)
    document.recompute()
    w.require(len(proxy.seen) == 1, "a recompute")
    w.require((obj.Name, 0) in proxy.seen[0], f"no mesh in the middle of it: {proxy.seen}")
    await w.wait_until(lambda: w.child("run").isEnabled(), "the end of the run")
    w.require(obj.FemMesh.NodeCount > 0, "a mesh after it")
    await w.close_panel()
    document.removeObject(slow.Name)


async def a_button_was_clicked(document, obj):
    """The object is made afterwards."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    await w.wait_until(lambda: w.buttons_of("Collarmesh_SizeSphere"), "the button")
    slow, proxy = slow_object(document, lambda: True)
    w.buttons_of("Collarmesh_SizeSphere")[0].click()
    document.recompute()
    w.require(not any("Size" in name for name, _ in proxy.seen[0]), f"nothing new in the middle of it: {proxy.seen}")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the size")


async def the_choice_is_gone_when_the_button_acts(document, obj):
    FreeCADGui.ActiveDocument.resetEdit()
    await w.wait_until(lambda: w.find("size_panel") is None, "the end of the panel")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    await w.wait_until(lambda: w.buttons_of("Collarmesh_SizeSphere"), "the button")
    w.buttons_of("Collarmesh_SizeSphere")[0].click()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.Plate)
    document.removeObject(obj.Name)
    await w.pause(200)
    w.require(w.find("size_panel") is None, "a size for nothing")


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    document = FreeCAD.newDocument("recompute")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = w.plate()
    obj = mesh_object.make(document, part)
    document.recompute()
    for happens in (a_run_ends, a_button_was_clicked, the_choice_is_gone_when_the_button_acts):
        print(happens.__name__, flush=True)
        await happens(document, obj)


w.run_test(test)
