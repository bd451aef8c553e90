"""The requested sizes as colours on the part: a button shows them, and everything that removes them restores
the part. Run by run.py --gui."""

import os
import sys

import FreeCAD
import FreeCADGui
from pivy import coin

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import mesh_object, size_objects, size_preview  # noqa: E402


def node():
    """Returns the node of the colours; None if there is none."""
    search = coin.SoSearchAction()
    search.setName(size_preview.NAME)
    search.apply(FreeCADGui.ActiveDocument.ActiveView.getSceneGraph())
    return search.getPath().getTail() if search.getPath() else None


def darkness_near(place):
    """Returns the sum of red, green and blue at the corner nearest to a place."""
    children = [node().getChild(i) for i in range(node().getNumChildren())]
    points = next(each for each in children if each.isOfType(coin.SoCoordinate3.getClassTypeId())).point.getValues()
    rgb = next(each for each in children if each.isOfType(coin.SoMaterial.getClassTypeId())).diffuseColor.getValues()
    nearest = min(range(len(points)), key=lambda i: (FreeCAD.Vector(*points[i]) - place).Length)
    return sum(rgb[nearest])


async def shown_and_hidden(part, obj):
    await w.open_panel(obj)
    await w.click(w.child("show_sizes"))
    await w.wait_until(lambda: node() is not None, "the colours")
    w.require(not part.ViewObject.Visibility, "the part is hidden")
    w.require(w.child("sizes_ends").text() == "0.5 mm … 4 mm", w.child("sizes_ends").text())
    corner, far = FreeCAD.Vector(40, 30, 5), FreeCAD.Vector(0, 0, 0)
    w.require(darkness_near(corner) < darkness_near(far) - 1, "small sizes are dark, large ones bright")
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    await w.screenshot("freecad_size_colours.png")
    w.child("CharacteristicLengthMax").setText("2 mm")
    await w.wait_until(lambda: w.child("sizes_ends").text() == "0.5 mm … 2 mm", "the new sizes")
    await w.click(w.child("show_sizes"))
    w.require(node() is None and part.ViewObject.Visibility and not w.child("sizes_ends").isVisible(), "as before")


async def the_end_of_the_panel_ends_it(part, obj):
    await w.click(w.child("show_sizes"))
    w.require(node() is not None, "the colours")
    await w.close_panel(w.QtGui.QDialogButtonBox.Cancel)
    w.require(node() is None and part.ViewObject.Visibility, "the panel's end ends it")
    w.require(obj.CharacteristicLengthMax.Value == 4, "nothing is changed")


async def a_run_ends_it(part, obj):
    await w.open_panel(obj)
    await w.click(w.child("show_sizes"))
    await w.run_mesher("4 mm")
    w.require(node() is None and obj.ViewObject.Visibility and not part.ViewObject.Visibility, "the mesh shows")
    await w.click(w.child("show_sizes"))
    w.require(node() is not None and not obj.ViewObject.Visibility, "and hides for the colours")
    part.Shape = w.plate().translated(FreeCAD.Vector(100, 0, 0))
    part.Document.recompute()
    await w.wait_until(lambda: node() is not None and darkness_near(FreeCAD.Vector(140, 30, 5)) > 0, "the new shape")
    await w.click(w.child("show_sizes"))
    w.require(obj.ViewObject.Visibility, "the mesh is back")
    await w.click(w.child("show_sizes"))
    FreeCAD.closeDocument(part.Document.Name)
    await w.wait_until(lambda: w.find("run") is None, "the panel's end")


async def test():
    document = FreeCAD.newDocument("preview")
    FreeCADGui.activateWorkbench("FemWorkbench")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = w.plate()
    obj = mesh_object.make(document, part)
    obj.CharacteristicLengthMax = 4
    sphere = size_objects.make(obj, "Sphere", 0.5)
    sphere.Placement.Base = FreeCAD.Vector(40, 30, 5)
    sphere.ViewObject.Visibility = False
    document.recompute()
    await shown_and_hidden(part, obj)
    await the_end_of_the_panel_ends_it(part, obj)
    await a_run_ends_it(part, obj)


w.run_test(test)
