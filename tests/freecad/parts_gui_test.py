"""The panel for parts of several solids, open parts and surfaces. Run by run.py --gui."""

import collections
import os
import sys

import FreeCAD
import FreeCADGui
import Part

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import mesh_object  # noqa: E402


def hub():
    """A hub in the bore of a plate."""
    plate = Part.makeBox(40, 40, 10).cut(Part.makeCylinder(8, 10, FreeCAD.Vector(20, 20, 0)))
    return Part.makeCompound([plate, Part.makeCylinder(8, 20, FreeCAD.Vector(20, 20, -5))])


async def solids_that_touch(document, part, obj):
    part.Shape = hub()
    document.recompute()
    await w.open_panel(obj)
    await w.wait_until(lambda: w.child("contacts").isVisible(), "the line on solids that touch")
    w.require("Face7 = Face8" in w.child("contacts").text(), w.child("contacts").text())
    await w.run_mesher("3 mm")
    await w.screenshot("contacts.png")
    part.Shape = w.plate()
    document.recompute()
    await w.wait_until(lambda: not w.child("contacts").isVisible(), "the end of that line")
    w.require(not w.child("KeepApart").isVisible(), "nothing to keep apart")
    boxes = [Part.makeBox(10, 10, 10, FreeCAD.Vector(10 * i, 0, 0)) for i in range(4)]
    part.Shape = Part.makeCompound(boxes)
    document.recompute()
    await w.wait_until(lambda: "3 faces" in w.child("contacts").text(), "the new line")
    w.require(w.child("contacts").toolTip().count("=") == 3, w.child("contacts").toolTip())
    await w.close_panel()


async def solids_are_kept_apart(document, part, obj):
    part.Shape = hub()
    document.recompute()
    await w.open_panel(obj)
    await w.run_mesher("3 mm")
    glued = obj.FemMesh.NodeCount
    w.require(nodes_twice(obj.FemMesh) == 0, "they are glued")
    await w.click(w.child("KeepApart"))
    w.require("Face7 = Face8: they are kept apart" in w.child("contacts").text(), w.child("contacts").text())
    await w.run_mesher("3 mm")
    doubled = nodes_twice(obj.FemMesh)
    w.require(obj.KeepApart and doubled > 50, f"{doubled} nodes are there twice")
    w.require(obj.FemMesh.NodeCount == glued + doubled, f"{glued} nodes and {doubled}, {obj.FemMesh.NodeCount} in all")
    w.require("Every guarantee holds" in w.said() and not w.child("out_of_date").isVisible(), w.said())
    await w.click(w.child("guarantees_fold"))
    w.require("✓ Solids that are kept apart share no node" in w.said(), w.said())
    await w.click(w.child("guarantees_fold"))
    await w.screenshot("freecad_apart.png")
    await w.click(w.child("KeepApart"))
    w.require("they are glued" in w.child("contacts").text(), w.child("contacts").text())
    await w.close_panel()
    document.recompute()
    await w.open_panel(obj)
    w.require(not obj.KeepApart and w.child("out_of_date").isVisible(), "the mesh is another one's")
    await w.run_mesher("3 mm")
    w.require(obj.FemMesh.NodeCount == glued, "they are glued again")
    await w.close_panel()


def nodes_twice(fem_mesh):
    """Returns the number of places with several nodes."""
    places = collections.Counter(tuple(round(x, 9) for x in point) for point in fem_mesh.Nodes.values())
    return sum(count > 1 for count in places.values())


def volumes():
    """Returns the rows of the table."""
    table = w.child("regions")
    return [[table.topLevelItem(i).text(c) for c in range(4)] for i in range(table.topLevelItemCount())]


async def volumes_of_solids(document, part, obj):
    part.Shape = hub()
    document.recompute()
    await w.open_panel(obj)
    await w.run_mesher("3 mm")
    w.require(w.child("regions").isVisible(), "the table of volumes")
    rows = volumes()
    w.require([row[0] for row in rows] == ["Solid1", "Solid2"], f"{rows}")
    for row, solid, name in zip(rows, part.Shape.Solids, ("Solid1", "Solid2")):
        w.require(abs(float(row[1]) / solid.Volume - 1) < 1e-4, f"{row} for {solid.Volume}")
        w.require(abs(float(row[2]) / volume_of(obj.FemMesh, name) - 1)
                  < 1e-4, f"{row} for {volume_of(obj.FemMesh, name)}")
        percent = 100 * (float(row[2]) / float(row[1]) - 1)
        w.require(abs(float(row[3].removesuffix(" %")) - percent) < 0.01, f"{row} for {percent} percent")
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    await w.screenshot("freecad_volumes.png")
    await w.close_panel()


def volume_of(fem_mesh, group):
    """Returns the volume of straight elements; that of curved ones is nearly the same."""
    number = next(n for n in fem_mesh.Groups if fem_mesh.getGroupName(n) == group)
    total = 0
    for element in fem_mesh.getGroupElements(number):
        a, b, c, d = (fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:4])
        total += abs((b - a).cross(c - a).dot(d - a)) / 6
    return total


async def open_surfaces_are_asked_about(document, part, obj):
    part.Shape = Part.makeShell(Part.makeBox(10, 10, 10).Faces[:5])
    document.recompute()
    before = obj.FemMesh.NodeCount
    await w.open_panel(obj)
    w.child("CharacteristicLengthMax").setText("3 mm")
    w.child("ElementDimension").setCurrentIndex(3)
    await w.click(w.child("run"))
    w.require("open at 4 edges" in w.child("question").text(), w.child("question").text())
    w.require(w.child("run").text() == "Fill the holes" and obj.FemMesh.NodeCount == before,
              "nothing is filled unasked")
    await w.screenshot("open_surface.png")
    await w.click(w.child("run"))
    await w.wait_until(lambda: w.child("message").isVisible(), "the mesh")
    w.require("A hole of the shape is filled, with 100 mm²" in w.said() and obj.FillHoles, w.said())
    w.require(abs(volume_of(obj.FemMesh, "Solid1") - 1000) < 1, "it is a whole box")
    await w.screenshot("open_surface_filled.png")
    obj.FillHoles = False
    await w.close_panel(w.QtGui.QDialogButtonBox.Cancel)


async def surfaces_and_wires_are_told_from_volumes(document, part, obj):
    box = Part.makeBox(10, 10, 10)
    for shape, word in ((box.Faces[0], "for shells"), (Part.Wire(box.Faces[0].Edges), "for beams")):
        part.Shape = shape
        document.recompute()
        await w.open_panel(obj)
        w.child("ElementDimension").setCurrentIndex(3)
        await w.click(w.child("run"))
        await w.wait_until(lambda: w.child("message").isVisible(), "the message")
        w.require(word in w.said(), w.said())
        await w.screenshot(f"no_volume_{word[-6:]}.png")
        await w.close_panel(w.QtGui.QDialogButtonBox.Cancel)


async def test():
    document = FreeCAD.newDocument("parts")
    FreeCADGui.activateWorkbench("FemWorkbench")
    part = document.addObject("Part::Feature", "Assembly")
    obj = mesh_object.make(document, part)
    await solids_that_touch(document, part, obj)
    await solids_are_kept_apart(document, part, obj)
    obj.ElementOrder = "1st"
    await volumes_of_solids(document, part, obj)
    await open_surfaces_are_asked_about(document, part, obj)
    await surfaces_and_wires_are_told_from_volumes(document, part, obj)


w.run_test(test)
