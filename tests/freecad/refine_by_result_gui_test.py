"""Refinement by a result in FreeCAD's window: the button, the panel's fields, a run, "Stop", undo, a result of another
mesh. Run by run.py --gui."""

import os
import sys

import FemGui
import FreeCADGui
import Part
from PySide import QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import analysis  # noqa: E402
import window as w  # noqa: E402
from freecad.collarmesh_workbench import mesh_object, result_refinement  # noqa: E402

COMMAND = "Collarmesh_RefineByResult"
FORCE = 4500


def plate():
    """An analysis of a quarter of a plate with a hole, pulled along x, with a coarse mesh."""
    made = analysis.Analysis(Part.makeBox(20, 15, 3).cut(Part.makeCylinder(5, 3)))
    made.hold("x", (0, 10, 1.5))
    made.hold("y", (12, 0, 1.5))
    made.hold("z", (12, 8, 0))
    made.pull((20, 7, 1.5), FORCE, (1, 0, 0))
    FemGui.setActiveAnalysis(made.analysis)
    made.mesh_object = made.add(mesh_object.make(made.document, made.part))
    made.mesh_object.CharacteristicLengthMax = 3
    mesh_object.remesh(made.mesh_object)
    made.mesh_object.ViewObject.Proxy.show_in_place_of_part()
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return made


async def the_button_needs_a_result(study):
    FreeCADGui.activateWorkbench("FemWorkbench")
    await w.wait_until(lambda: w.buttons_of(COMMAND, grey=True), "the button")
    await w.pause(500)
    w.require(not w.buttons_of(COMMAND), "it is grey without a result")
    await w.open_panel(study.mesh_object)
    w.require(not w.child("refine_fold").isVisible(), "the panel does not offer it without a result")
    await w.close_panel()
    study.solve()


async def the_panel_estimates(study):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(result_refinement.result_of(study.mesh_object))
    await w.click_command(COMMAND)
    await w.wait_until(lambda: w.find("refine") is not None and w.child("refine").isVisible(), "the fields")
    count = study.mesh_object.FemMesh.VolumeCount
    note = w.child("refine_note").text()
    w.require("estimated error" in note and study_label(study) in note, note)
    w.require(w.child("refine_elements").value() == 2 * count, f"{w.child('refine_elements').value()} of {count}")
    await w.screenshot("freecad_refine_by_result.png")


def study_label(study):
    return result_refinement.result_of(study.mesh_object).Label


async def the_fields_follow_each_other(study):
    elements, error = w.child("refine_elements"), w.child("refine_error")
    before = error.value()
    elements.setValue(4 * study.mesh_object.FemMesh.VolumeCount)
    w.require(error.value() < before, f"more elements, error {before} and {error.value()}")
    few = elements.value()
    error.setValue(error.value() / 2)
    w.require(elements.value() > few, f"less error, elements {few} and {elements.value()}")


async def a_run(study):
    old = study.mesh_object.FemMesh.VolumeCount
    w.child("refine_elements").setValue(6 * old)
    await w.click(w.child("refine"))
    await w.wait_until(lambda: w.child("run").isEnabled(), "the end of the run")
    said = w.said()
    w.require("Every guarantee holds" in said, said)
    count = study.mesh_object.FemMesh.VolumeCount
    w.require(0.7 < count / (6 * old) < 1.4, f"{count} elements, {6 * old} were asked for")
    w.require(not w.child("out_of_date").isVisible(), "the mesh is up to date")
    w.require("result of another mesh" in w.child("refine_note").text(), w.child("refine_note").text())
    w.require(not w.child("refine").isEnabled(), "a result refines only its own mesh")
    await w.screenshot("freecad_refined.png")
    await w.close_panel()
    return old


async def undo_brings_the_mesh_and_its_estimate_back(study, old):
    new = study.mesh_object.FemMesh.VolumeCount
    study.document.undo()
    w.require(study.mesh_object.FemMesh.VolumeCount == old, "undo")
    w.require(result_refinement.plan(study.mesh_object) is not None, "the result is that of the old mesh")
    study.document.redo()
    w.require(study.mesh_object.FemMesh.VolumeCount == new, "redo")


async def stop_keeps_the_mesh(study):
    study.solve()
    old = study.mesh_object.FemMesh.VolumeCount
    await w.click_command(COMMAND)
    await w.wait_until(lambda: w.find("refine") is not None and w.child("refine").isEnabled(), "the fields")
    w.child("refine_elements").setValue(64 * old)
    await w.click(w.child("refine"))
    await w.click(w.child("cancel"))
    await w.wait_until(lambda: w.child("run").isEnabled(), "the end of the run")
    w.require("Cancelled" in w.said(), w.said())
    w.require(study.mesh_object.FemMesh.VolumeCount == old, "the mesh is the one from before")
    w.require(w.child("refine").isEnabled(), "the result is still that of this mesh")
    await w.close_panel()


async def the_context_menu(study):
    menu = QtGui.QMenu()
    study.mesh_object.ViewObject.Proxy.setupContextMenu(study.mesh_object.ViewObject, menu)
    entry = next(each for each in menu.actions() if each.objectName() == "collarmesh_refine_by_result")
    w.require(entry.isEnabled(), "with a result")
    entry.trigger()
    await w.wait_until(lambda: w.find("refine") is not None and w.child("refine").isVisible(), "the fields")
    await w.close_panel(QtGui.QDialogButtonBox.Cancel)


async def test():
    study = plate()
    await the_button_needs_a_result(study)
    await the_panel_estimates(study)
    await the_fields_follow_each_other(study)
    old = await a_run(study)
    await undo_brings_the_mesh_and_its_estimate_back(study, old)
    await stop_keeps_the_mesh(study)
    await the_context_menu(study)


w.run_test(test)
