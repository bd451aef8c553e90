"""From triangles to stresses by clicks: a mesh, faces for its groups, FEM's own panels for constraints, CalculiX. Run
by run.py --gui."""

import os
import sys

import Fem
import FemGui
import FreeCADGui
import Mesh
import Part
from PySide import QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import analysis  # noqa: E402
import window as w  # noqa: E402
from freecad.collarmesh_workbench import constraint_faces, mesh_object  # noqa: E402

FORCE = 200


async def mesh_and_faces(part, obj):
    """Makes the faces by the panel's button; returns the object with the faces."""
    await w.open_panel(obj)
    w.require(not w.child("constraint_faces").isVisible(), "faces of a mesh that is not there")
    await w.run_mesher("5 mm")
    await w.click(w.child("constraint_faces"))
    faces = constraint_faces.of(obj)
    w.require(faces is not None, "faces for constraints")
    shown = [each.ViewObject.Visibility for each in (faces, obj, part)]
    w.require(shown == [True, False, False], f"shown: faces, mesh, part {shown}")
    await w.click(w.child("constraint_faces"))
    w.require(constraint_faces.of(obj) is faces, "other faces at the second click")
    await w.screenshot("constraint_faces.png")
    await w.close_panel()
    colours = faces.ViewObject.DiffuseColor
    w.require(len(colours) == len(faces.Groups), f"{len(colours)} colours")
    w.require(len(set(colours)) == len(set(faces.Groups)), "each group has its colour")
    return faces


async def click_without_mesh(obj):
    """Asks for faces of a mesh that disappears while the panel is open."""
    await w.open_panel(obj)
    obj.FemMesh = Fem.FemMesh()
    await w.click(w.child("constraint_faces"))
    w.require("need a mesh with elements" in w.said(), w.said())
    await w.close_panel()


async def constrain(command, faces, face, picture):
    """Puts a constraint on a face by FEM's own button and panel; returns the constraint."""
    before = set(faces.Document.Objects)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.runCommand(command)
    await w.wait_until(lambda: any(each.isVisible() for each in adding()), "FEM's panel")
    await w.click(next(each for each in adding() if each.isVisible()))
    FreeCADGui.Selection.addSelection(faces, face)  # FEM's panel takes what is selected when it opens
    await w.pause(100)
    await w.screenshot(picture)
    boxes = [box for box in w.window.findChildren(QtGui.QDialogButtonBox) if box.isVisible()]
    await w.click(boxes[0].button(QtGui.QDialogButtonBox.Ok))
    await w.wait_until(lambda: not FreeCADGui.Control.activeDialog(), "the end of FEM's panel")
    (made,) = set(faces.Document.Objects) - before
    return made


def adding():
    return w.window.findChildren(QtGui.QAbstractButton, "btnAdd")


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    study = analysis.Analysis(Part.makeBox(1, 1, 1))
    document = study.document
    document.UndoMode = 1
    document.removeObject(study.part.Name)
    FemGui.setActiveAnalysis(study.analysis)
    part = document.addObject("Mesh::Feature", "Triangles")
    part.Mesh = Mesh.Mesh(w.plate().tessellate(0.02))
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    study.mesh_object = mesh_object.make(document, part)
    study.analysis.addObject(study.mesh_object)
    faces = await mesh_and_faces(part, study.mesh_object)
    groups = list(faces.Groups)
    curved = max(groups, key=groups.count)
    side = min(range(len(groups)), key=lambda i: faces.Shape.Faces[i].CenterOfMass.x)
    fixed = await constrain("FEM_ConstraintFixed", faces, f"Face{side + 1}", "constraint_fixed.png")
    w.require(fixed.References == [(faces, (f"Face{side + 1}",))], f"{fixed.References}")
    study.held[fixed.Name.upper()] = "xyz"
    last = len(groups) - groups[::-1].index(curved)
    force = await constrain("FEM_ConstraintForce", faces, f"Face{last}", "freecad_groups.png")
    w.require(force.References == [(faces, (f"Face{groups.index(curved) + 1}",))], f"{force.References}")
    force.Force, force.Direction = FORCE, study.edge_along((1, 0, 0), faces)
    result = study.solve()
    w.require(abs(abs(result["reactions"][0]) / FORCE - 1) < 1e-4, f"reactions {result['reactions']}")
    w.require(result["displacement"] > 0, "a displacement")
    FreeCADGui.activeDocument().ActiveView.viewIsometric()
    await w.screenshot("constrained.png")
    await click_without_mesh(study.mesh_object)


w.run_test(test)
