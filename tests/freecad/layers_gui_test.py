"""Boundary layers in FreeCAD's window: button, panel, faces by name and by selection, cancel, undo, and what the
mesh's panel says about them. Run by run.py --gui."""

import os
import sys

import FreeCAD
import FreeCADGui
from PySide import QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import layer_objects, mesh_object, size_objects  # noqa: E402

HOLE = "Face7"


def names_of(layers):
    return [name for _, name in size_objects.references(layers)]


def is_red(widget):
    return "color" in widget.styleSheet()


async def press(button):
    """Clicks a button below the panel."""
    def boxes():
        found = w.window.findChildren(QtGui.QDialogButtonBox)
        return [each for each in found if each.isVisible() and each.button(button)]

    await w.wait_until(boxes, "the buttons")
    await w.click(boxes()[0].button(button))
    await w.wait_until(lambda: w.find("layers_panel") is None, "the panel's end")


async def enter(name, text):
    w.child("layers_" + name).setText(text)
    await w.pause(50)


async def layers_by_their_button(obj, part):
    FreeCADGui.activateWorkbench("FemWorkbench")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part, HOLE)
    await w.click_command("Collarmesh_Layers")
    await w.wait_until(lambda: w.find("layers_panel") is not None, "the panel of the layers")
    (layers,) = obj.MeshLayerList
    w.require(layers in obj.ViewObject.Proxy.claimChildren(), "they are below the mesh object in the tree")
    w.require(names_of(layers) == [HOLE], f"the selected face is taken: {names_of(layers)}")
    w.require(abs(layers.Shape.Area - part.Shape.getElement(HOLE).Area) < 1e-6, "its face shows")
    return layers


async def faces_by_name_and_by_selection(layers, part):
    w.require(w.child("layers_faces").text() == HOLE, "the field has the name")
    await enter("faces", "Face1, Face99")
    w.require(is_red(w.child("layers_faces")), "an unknown name is red")
    w.require(names_of(layers) == [HOLE], "and is not stored")
    await enter("faces", "Face1 Face2")
    w.require(not is_red(w.child("layers_faces")), "known names are not")
    w.require(names_of(layers) == ["Face1", "Face2"], f"{names_of(layers)}")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part, HOLE)
    FreeCADGui.Selection.addSelection(part, "Face2")
    await w.click(w.child("layers_add"))
    w.require(names_of(layers) == ["Face1", "Face2", HOLE], f"{names_of(layers)}")
    w.require(w.child("layers_faces").text() == f"Face1, Face2, {HOLE}", "the field follows")
    await enter("faces", "")
    w.require(names_of(layers) == [], "without names, all outer faces are meant")
    await enter("faces", HOLE)


async def heights_and_number(layers, obj):
    await enter("FirstHeight", "0.2 mm")
    w.child("layers_Count").setValue(4)
    w.child("layers_Growth").setValue(1.5)
    w.require((layers.FirstHeight.Value, layers.Count, layers.Growth) == (0.2, 4, 1.5), "the values are stored")
    w.require("1.625 mm" in w.child("layers_note").text(), w.child("layers_note").text())
    await enter("Thickness", "3.25 mm")
    w.require("0.4 mm" in w.child("layers_note").text(), w.child("layers_note").text())
    w.require(not w.child("layers_FirstHeight").isEnabled(), "the first height follows from the thickness")
    await enter("Thickness", "")
    w.require(w.child("layers_FirstHeight").isEnabled() and layers.Thickness.Value == 0, "and is free again")
    await enter("FirstHeight", "thick")
    w.require(is_red(w.child("layers_FirstHeight")) and layers.FirstHeight.Value == 0.2, "no value is red")
    await enter("FirstHeight", "0.2 mm")
    w.child("layers_tetrahedra").setChecked(True)
    w.require(obj.LayersAsTetrahedra, "tetrahedra are chosen")
    w.child("layers_tetrahedra").setChecked(False)


async def cancel_and_undo(document, obj, layers):
    """Creation and first edit are one undo step."""
    name = layers.Name
    await press(QtGui.QDialogButtonBox.Cancel)
    w.require(document.getObject(name) is None and obj.MeshLayerList == [], "cancel takes new layers back")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    await w.click_command("Collarmesh_Layers")
    await w.wait_until(lambda: w.find("layers_panel") is not None, "the panel of the layers")
    await enter("faces", f"Face2, {HOLE}")
    await enter("FirstHeight", "0.2 mm")
    w.child("layers_Count").setValue(4)
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    await w.screenshot("freecad_layers_panel.png")
    await press(QtGui.QDialogButtonBox.Ok)
    (layers,) = obj.MeshLayerList
    document.undo()
    w.require(obj.MeshLayerList == [], "undo of the creation")
    document.redo()
    (layers,) = obj.MeshLayerList
    w.require(layers.Count == 4 and layer_objects.is_ours(layers), "redo")
    layers.ViewObject.doubleClicked()
    await w.wait_until(lambda: w.find("layers_panel") is not None, "the panel after a double click")
    w.require(w.child("layers_faces").text() == f"Face2, {HOLE}", "it has the names")
    await press(QtGui.QDialogButtonBox.Ok)


async def the_mesh_has_them(obj):
    await w.open_panel(obj)
    said = await w.run_mesher("4 mm")
    w.require("Every guarantee holds" in said, said)
    w.require("prisms" in w.child("counts").text() and "100.0% of the faces" in w.child("counts").text(), said)
    w.require("Elements of layers are not inverted" in w.child("guarantees").text(), "the guarantees tell of layers")
    w.require("Lower layers" not in said, said)
    w.require(obj.FemMesh.PrismCount > 0, "there are prisms")
    await w.screenshot("freecad_layers.png")
    await w.close_panel()


async def lower_ones_are_shown(obj):
    """All faces of a plate of 5 mm cannot have layers of 2 mm each."""
    (layers,) = obj.MeshLayerList
    layers.References, layers.Thickness = [], 2
    await w.open_panel(obj)
    said = await w.run_mesher("4 mm")
    w.require("Every guarantee holds" in said, said)
    w.require("the gap to the opposite face is narrow" in said and "nodes, down to" in said, said)
    lower = next(items for heading, items in w.rows(w.child("places")).items() if heading.startswith("Lower layers"))
    await w.click_item(lower[0])
    await w.pause(200)
    await w.screenshot("freecad_lower_layers.png")
    w.require(obj.ViewObject.RootNode.getByName("collarmesh_marks") is not None, "the panel marks the place")
    await w.close_panel()


async def test():
    document = FreeCAD.newDocument("layers")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = w.plate()
    document.recompute()
    obj = mesh_object.make(document, part)
    document.recompute()
    layers = await layers_by_their_button(obj, part)
    await faces_by_name_and_by_selection(layers, part)
    await heights_and_number(layers, obj)
    await cancel_and_undo(document, obj, layers)
    await the_mesh_has_them(obj)
    await lower_ones_are_shown(obj)


w.run_test(test)
