"""Panels, objects and documents are closed while the program works for them: FreeCAD survives. Run by run.py
--gui."""

import os
import pathlib
import stat
import sys
import tempfile

import FreeCAD
import FreeCADGui

from freecad.collarmesh_workbench import mesh_object

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402


def slow_program(folder):
    """Makes a program that never answers."""
    path = pathlib.Path(folder, "program")
    path.write_text("#!/bin/sh\nexec sleep 100\n", encoding="ascii")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


async def open_and_predict():
    document = FreeCAD.newDocument("closing")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = w.plate()
    obj = mesh_object.make(document, part)
    document.recompute()
    await w.open_panel(obj)
    predictions = obj.ViewObject.Proxy.panel.predictions
    await w.wait_until(lambda: predictions._process is not None, "a prediction")
    del predictions
    return document, obj


async def the_panel_closes(document, obj):
    await w.close_panel()


async def the_object_is_deleted(document, obj):
    document.removeObject(obj.Name)
    await w.wait_until(lambda: w.find("run") is None, "the panel's end")


async def another_object_is_edited(document, obj):
    other = mesh_object.make(document, document.Plate)
    FreeCADGui.getDocument(document.Name).resetEdit()
    await w.open_panel(other)


async def the_document_closes(document, obj):
    FreeCAD.closeDocument(document.Name)
    await w.wait_until(lambda: w.find("run") is None, "the panel's end")


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    program = os.environ["COLLARMESH_PROGRAM"]
    with tempfile.TemporaryDirectory() as folder:
        os.environ["COLLARMESH_PROGRAM"] = slow_program(folder)
        for goes in (the_panel_closes, the_object_is_deleted, another_object_is_edited, the_document_closes):
            print(goes.__name__, flush=True)
            document, obj = await open_and_predict()
            name = document.Name
            await goes(document, obj)
            await w.pause(300)
            if name in FreeCAD.listDocuments():
                FreeCAD.closeDocument(name)
                await w.pause(100)
    os.environ["COLLARMESH_PROGRAM"] = program


w.run_test(test)
