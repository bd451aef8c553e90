"""Sizes as objects in FreeCAD's window: buttons, tree, panels, handles that are dragged, cancel, undo. Run by
run.py --gui."""

import os
import sys

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore, QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import commands, fem_buttons, mesh_object, size_objects  # noqa: E402

KINDS = ("Sphere", "Box", "Cylinder", "Distance")


def view():
    return FreeCADGui.ActiveDocument.ActiveView


def on_screen(place):
    """Converts a place in mm to a point of the 3D view."""
    x, y = view().getPointOnScreen(place)
    width, height = view().getSize()
    scale = view().graphicsView().width() / width  # in Qt's pixels
    return QtCore.QPoint(round(x * scale), round((height - 1 - y) * scale))


async def wait_for_camera():
    """Waits until the view rests: it moves for a while after a change."""
    seen = []
    while len(seen) < 4 or seen[-1] != seen[-4]:
        seen.append((on_screen(FreeCAD.Vector()), on_screen(FreeCAD.Vector(1, 2, 3)), view().getSize()))
        await w.pause(100)


async def drag(obj, name, by, steps=8):
    """Drags a handle's head with the left button. `name`: of a length, or of the axis along which it moves
    the object."""
    await wait_for_camera()
    handle = next(each for each in obj.ViewObject.Proxy.panel.handles.handles if each.name == name)
    turn = FreeCAD.Rotation(*handle.transform.rotation.getValue().getValue())
    start = FreeCAD.Vector(*handle.transform.translation.getValue().getValue())
    start += turn.multVec(FreeCAD.Vector(0.85 * handle.scale, 0, 0))
    end = start + by
    target = view().graphicsView().viewport()
    points = [start + (end - start) * (i / steps) for i in range(steps + 1)]
    kinds = [QtCore.QEvent.MouseMove, QtCore.QEvent.MouseButtonPress] + [QtCore.QEvent.MouseMove] * steps
    kinds.append(QtCore.QEvent.MouseButtonRelease)
    places = [points[0], *points, points[-1]]
    held = False
    for kind, place in zip(kinds, places):
        held = kind == QtCore.QEvent.MouseButtonPress or (held and kind != QtCore.QEvent.MouseButtonRelease)
        button = QtCore.Qt.NoButton if kind == QtCore.QEvent.MouseMove else QtCore.Qt.LeftButton
        event = QtGui.QMouseEvent(kind, QtCore.QPointF(on_screen(place)), target.mapToGlobal(on_screen(place)), button,
                                  QtCore.Qt.LeftButton if held else QtCore.Qt.NoButton, QtCore.Qt.NoModifier)
        QtGui.QApplication.sendEvent(target, event)
        await w.pause(30)


def action(command):
    """Returns whether a command is in a toolbar."""
    return any(
        each.objectName() == command
        for bar in w.window.findChildren(QtGui.QToolBar)
        for each in bar.actions()
    )


async def enter(name, text):
    """Types into a field of the panel."""
    w.child("size_" + name).setText(text)
    await w.pause(50)


def shown(name):
    return FreeCAD.Units.Quantity(w.child("size_" + name).text()).Value


async def press(button):
    """Clicks a button below the panel."""
    def boxes():
        found = w.window.findChildren(QtGui.QDialogButtonBox)
        return [each for each in found if each.isVisible() and each.button(button)]

    await w.wait_until(boxes, "the buttons")
    await w.click(boxes()[0].button(button))
    await w.wait_until(lambda: w.find("size_panel") is None, "the panel's end")


async def buttons_are_in_fem():
    FreeCADGui.activateWorkbench("FemWorkbench")
    for kind in KINDS:
        await w.wait_until(lambda: action(f"Collarmesh_Size{kind}"), f"the button of {kind}")


async def a_sphere_by_its_button(document, obj):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    await w.click_command("Collarmesh_SizeSphere")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the sphere")
    (sphere,) = obj.MeshSizeList
    w.require(sphere in obj.ViewObject.Proxy.claimChildren(), "it is below the mesh object in the tree")
    w.require(sphere.ViewObject.Transparency > 50, "it is translucent")
    w.require(sphere.ViewObject.RootNode.getByName("collarmesh_size_handles") is not None, "it has handles")
    return sphere


async def fields_change_the_sphere(sphere):
    await enter("Size", "0.6 mm")
    await enter("Radius", "5 mm")
    await enter("x", "10 mm")
    w.require(sphere.Size.Value == 0.6 and sphere.Radius.Value == 5, f"{sphere.Size} {sphere.Radius}")
    w.require(abs(sphere.Placement.Base.x - 10) < 1e-9, f"{sphere.Placement}")
    w.require(abs(sphere.Shape.BoundBox.XLength - 10) < 0.1, "the shape follows")


async def handles_change_the_sphere(sphere):
    view().viewTop()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    centre = sphere.Placement.Base
    await drag(sphere, "Radius", FreeCAD.Vector(4, 0, 0))
    w.require(abs(sphere.Radius.Value - 9) < 0.5, f"the radius is dragged to {sphere.Radius}")
    w.require(abs(shown("Radius") - sphere.Radius.Value) < 0.01, "the field follows")
    w.require((sphere.Placement.Base - centre).Length < 1e-9, "it stays where it is")


async def the_centre_moves(sphere):
    centre, radius = sphere.Placement.Base, sphere.Radius.Value
    await drag(sphere, "X", FreeCAD.Vector(6, 0, 0))
    w.require(
        (sphere.Placement.Base - centre - FreeCAD.Vector(6, 0, 0)).Length < 0.5,
        f"it is dragged to {sphere.Placement.Base}",
    )
    centre = sphere.Placement.Base
    await drag(sphere, "Y", FreeCAD.Vector(0, -5, 0))
    w.require(
        (sphere.Placement.Base - centre - FreeCAD.Vector(0, -5, 0)).Length < 0.5,
        f"it is dragged to {sphere.Placement.Base}",
    )
    w.require(sphere.Radius.Value == radius, "its radius stays")
    w.require(abs(shown("x") - sphere.Placement.Base.x) < 0.01, "the field follows")


async def cancel_and_undo(document, obj):
    """Creation and first edit are one undo step; later edits are further steps."""
    name = obj.MeshSizeList[0].Name
    await press(QtGui.QDialogButtonBox.Cancel)
    w.require(document.getObject(name) is None and obj.MeshSizeList == [], "cancel takes the new sphere back")
    FreeCADGui.Selection.addSelection(obj)
    await w.click_command("Collarmesh_SizeSphere")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the sphere")
    await enter("Radius", "3 mm")
    await press(QtGui.QDialogButtonBox.Ok)
    (sphere,) = obj.MeshSizeList
    w.require(sphere.Radius.Value == 3, "OK keeps it")
    for button, radius in ((QtGui.QDialogButtonBox.Cancel, 3), (QtGui.QDialogButtonBox.Ok, 6)):
        await w.wait_until(lambda: FreeCADGui.ActiveDocument.getInEdit() is None, "the end of the edit")
        sphere.ViewObject.doubleClicked()
        await w.wait_until(lambda: w.find("size_panel") is not None, "the panel after a double click", 5)
        await enter("Radius", "6 mm")
        await press(button)
        w.require(sphere.Radius.Value == radius, f"{sphere.Radius} in place of {radius}")
        w.require(
            sphere.ViewObject.RootNode.getByName("collarmesh_size_handles") is None, "the handles are gone"
        )
    document.undo()
    w.require(sphere.Radius.Value == 3, "undo of the edit")
    document.undo()
    w.require(obj.MeshSizeList == [], "undo of the creation")
    document.redo()
    document.redo()
    (sphere,) = obj.MeshSizeList
    w.require(sphere.Radius.Value == 6, "redo of both")
    w.require(size_objects.kind_of(sphere) == "Sphere", "it is a sphere again")


async def a_box_and_a_cylinder(document, part):
    """The mesh object need not be selected if it is the only one, or if its part is selected."""
    FreeCADGui.Selection.clearSelection()
    await w.click_command("Collarmesh_SizeBox")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the box")
    box = document.getObject("SizeBox")
    for name, text in (
        ("Length", "8 mm"),
        ("Width", "6 mm"),
        ("Height", "4 mm"),
        ("x", "28 mm"),
        ("y", "2 mm"),
        ("z", "0 mm"),
    ):
        await enter(name, text)
    view().viewTop()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    await drag(box, "Width", FreeCAD.Vector(0, 4, 0))
    w.require(
        abs(box.Width.Value - 10) < 0.5 and box.Length.Value == 8, f"the width is dragged to {box.Width}"
    )
    await drag(box, "Length", FreeCAD.Vector(2, 0, 0))
    w.require(abs(box.Length.Value - 10) < 0.5, f"the length is dragged to {box.Length}")
    await press(QtGui.QDialogButtonBox.Ok)
    FreeCADGui.Selection.addSelection(part, "Edge1")
    await w.click_command("Collarmesh_SizeCylinder")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the cylinder")
    cylinder = document.getObject("SizeCylinder")
    edge = part.Shape.Edge1.BoundBox.Center
    w.require((cylinder.Shape.BoundBox.Center - edge).Length < 0.1, "it is at the edge that was selected")
    view().viewFront()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    height = cylinder.Height.Value
    await drag(cylinder, "Height", FreeCAD.Vector(0, 0, 3))
    w.require(
        abs(cylinder.Height.Value - height - 3) < 0.5,
        f"the height is dragged from {height} to {cylinder.Height}",
    )
    await press(QtGui.QDialogButtonBox.Ok)
    return box


async def a_sphere_at_a_hole(document, part):
    """The middle of a hole is on its axis, although boxes around curved faces are larger than the faces."""
    hole = next(i for i, face in enumerate(part.Shape.Faces, 1) if type(face.Surface).__name__ == "Cylinder")
    before = {each.Name for each in document.Objects}
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part, f"Face{hole}")
    await w.click_command("Collarmesh_SizeSphere")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the sphere")
    (sphere,) = (each for each in document.Objects if each.Name not in before)
    away = sphere.Placement.Base - part.Shape.Faces[hole - 1].CenterOfMass
    w.require(away.Length < 1e-9, f"it is {away} away from the middle of the hole")
    await press(QtGui.QDialogButtonBox.Cancel)


async def transform_by_freecad(box):
    """FreeCAD's own dragger, as opened by "Transform" in the context menu."""
    document = FreeCADGui.ActiveDocument
    document.setEdit(box.Name, 1)
    await w.pause(300)
    w.require(document.getInEdit() is not None, "FreeCAD's dragger is there")
    w.require(w.find("size_panel") is None, "without our panel")
    document.resetEdit()
    await w.pause(100)


async def distance_of_selected_faces(document, obj, part):
    FreeCADGui.Selection.clearSelection()
    hole = next(i for i, face in enumerate(part.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder))
    FreeCADGui.Selection.addSelection(part, f"Face{hole}")
    await w.click_command("Collarmesh_SizeDistance")
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the distance")
    distance = document.getObject("SizeDistance")
    w.require(size_objects.references(distance) == [(part, f"Face{hole}")], "the selected face is taken")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part, "Edge1")
    await w.click(w.child("size_add"))
    w.require(
        [name for _, name in size_objects.references(distance)] == [f"Face{hole}", "Edge1"],
        "an edge is added",
    )
    listed = w.child("size_references")
    w.require(listed.item(1).text() == "Plate: Edge1", listed.item(1).text())
    listed.item(1).setSelected(True)
    await w.click(w.child("size_remove"))
    w.require(
        [name for _, name in size_objects.references(distance)] == [f"Face{hole}"], "the edge is removed"
    )
    await enter("Size", "0.5 mm")
    await enter("Within", "1 mm")
    await press(QtGui.QDialogButtonBox.Ok)
    w.require(distance.Within.Value == 1 and distance.Size.Value == 0.5, "the values are stored")
    w.require(abs(distance.Shape.Area - part.Shape.Faces[hole - 1].Area) < 1e-6, "its face shows")
    w.require(len(obj.ViewObject.Proxy.claimChildren()) == 4, "all are below the mesh object")


def the_mesh_has_the_sizes(obj):
    without = 0
    sizes, obj.MeshSizeList = obj.MeshSizeList, []
    mesh_object.remesh(obj)
    without = obj.FemMesh.VolumeCount
    obj.MeshSizeList = sizes
    mesh_object.remesh(obj)
    w.require(
        obj.FemMesh.VolumeCount > 3 * without, f"{obj.FemMesh.VolumeCount} tets with sizes, {without} without"
    )


async def a_picture_of_all(document, obj, part):
    part.ViewObject.Visibility = False
    document.SizeSphere.Placement.Base = FreeCAD.Vector(8, 24, 5)
    document.SizeBox.Placement.Base = FreeCAD.Vector(28, 1, 2)
    document.recompute()
    mesh_object.remesh(obj)
    obj.ViewObject.Transparency = 40
    view().viewIsometric()
    for tree in w.window.findChildren(QtGui.QTreeWidget):
        tree.expandAll()
    await w.screenshot("freecad_sizes.png")


async def test():
    document = FreeCAD.newDocument("sizes")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = w.plate()
    document.recompute()
    await buttons_are_in_fem()
    obj = mesh_object.make(document, part)
    obj.CharacteristicLengthMax = 4
    document.recompute()
    sphere = await a_sphere_by_its_button(document, obj)
    await fields_change_the_sphere(sphere)
    await handles_change_the_sphere(sphere)
    await the_centre_moves(sphere)
    view().viewIsometric()
    await w.screenshot("freecad_size_handles.png")
    await cancel_and_undo(document, obj)
    box = await a_box_and_a_cylinder(document, part)
    await transform_by_freecad(box)
    await distance_of_selected_faces(document, obj, part)
    await a_sphere_at_a_hole(document, part)
    the_mesh_has_the_sizes(obj)
    await a_picture_of_all(document, obj, part)


w.run_test(test)
