"""Mesh objects in FreeCAD's tree: the mark of outdated ones, context menus, taking over, export, statistics,
undo. Run by run.py --gui."""

import os
import sys
import tempfile

import FreeCAD
import FreeCADGui
import FemGui
import Mesh
import ObjectsFem
import Part
from PySide import QtCore, QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import (mesh_object, mesh_properties, take_over, up_to_date,  # noqa: E402
                                          view_provider)
from freecad.collarmesh_workbench.commands import GROUP_COMMAND, MESH_COMMAND, REFINEMENT_COMMAND  # noqa: E402


def tree_item(label):
    """Returns the item of the object with a label in FreeCAD's tree."""
    found = [item for tree in w.window.findChildren(QtGui.QTreeWidget) if tree.isVisible()
             for item in tree.findItems(label, QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive, 0)]
    w.require(len(found) == 1, f"{len(found)} times {label} in the tree")
    return found[0]


def icon_of(label):
    """Returns the pixels of its icon in the tree."""
    image = tree_item(label).icon(0).pixmap(32, 32).toImage()
    return [image.pixel(x, y) for x in range(image.width()) for y in range(image.height())]


async def show_model():
    """Shows the tab with the tree."""
    tree = next(iter(w.window.findChildren(QtGui.QTreeWidget)))
    for tabs in w.window.findChildren(QtGui.QTabWidget):
        for i in range(tabs.count()):
            if tabs.widget(i).isAncestorOf(tree):
                tabs.setCurrentIndex(i)
    for each in w.window.findChildren(QtGui.QTreeWidget):
        each.expandAll()
    await w.pause(200)


async def menu_of(label, choose=None, picture=""):
    """Opens the context menu of an object in the tree; returns its texts. `choose`: the entry to click."""
    await show_model()
    item = tree_item(label)
    await w.click_item(item)
    texts = []

    def look():
        menu = QtGui.QApplication.activePopupWidget()
        if menu is None:
            QtCore.QTimer.singleShot(100, look)
            return
        if picture and w.PICTURES:
            w.save_screen(picture)
        texts.extend(action.text() for action in menu.actions())
        entry = next(
            (action for action in menu.actions() if action.objectName() == f"collarmesh_{choose}"), None
        )
        if entry is not None:
            entry.trigger()
        menu.close()

    QtCore.QTimer.singleShot(100, look)
    tree = item.treeWidget()
    place = tree.visualItemRect(item).center()
    QtGui.QCursor.setPos(tree.viewport().mapToGlobal(place))  # the place where FreeCAD opens the menu
    event = QtGui.QContextMenuEvent(QtGui.QContextMenuEvent.Mouse, place, tree.viewport().mapToGlobal(place))
    QtGui.QApplication.sendEvent(tree.viewport(), event)
    await w.wait_until(lambda: texts, "the menu")
    await w.pause(300)
    return texts


async def a_changed_shape_marks_its_mesh(document, part, obj):
    await show_model()
    await w.pause(500)  # icons are drawn a moment later
    fresh = icon_of(obj.Label)
    count = obj.FemMesh.VolumeCount
    part.Radius = 7
    document.recompute()
    await w.wait_until(lambda: icon_of(obj.Label) != fresh, "the icon in the tree shows it", 10)
    w.require(obj.ViewObject.Proxy.getIcon() == view_provider.OUT_OF_DATE_ICON, "by the mark")
    w.require(obj.FemMesh.VolumeCount == count, "nothing is meshed by a recompute")
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    await w.screenshot("freecad_out_of_date.png")
    part.Radius = 6
    document.recompute()
    await w.wait_until(lambda: icon_of(obj.Label) == fresh, "the mark goes when the shape is as before", 10)
    document.openTransaction("Radius")
    part.Radius = 7
    document.recompute()
    document.commitTransaction()
    await w.wait_until(lambda: icon_of(obj.Label) != fresh, "the mark again", 10)
    document.undo()
    await w.wait_until(lambda: icon_of(obj.Label) == fresh, "the mark goes by undo, too", 10)


async def mesh_again_by_the_menu(document, part, obj):
    part.Radius = 8
    document.recompute()
    if w.PICTURES:
        await w.make_small()
    entries = await menu_of(obj.Label, "mesh_again", "freecad_menu.png")
    w.window.setGeometry(*w.WIDE)
    for text in ("Edit mesh", "Mesh again", "Export mesh...", "Statistics...", "Hand over to Gmsh"):
        w.require(text in entries, f"{text} is not in {entries}")
    await w.wait_until(lambda: w.find("run") is not None, "the panel")
    await w.wait_until(lambda: not up_to_date.is_out_of_date(obj) and w.child("run").isEnabled(), "the new mesh")
    w.require(obj.FemMesh.VolumeCount > 100, "it has elements")
    w.require(obj.ViewObject.Proxy.getIcon() == view_provider.ICON, "the mark is gone")
    await w.close_panel()


async def statistics_and_export(obj):
    if w.PICTURES:
        await w.make_small()
    await menu_of(obj.Label, "statistics")
    await w.wait_until(lambda: w.find("statistics") is not None, "the statistics")
    text = w.find("statistics").findChild(QtGui.QTextBrowser).toPlainText()
    for word in (str(obj.FemMesh.VolumeCount), str(obj.FemMesh.NodeCount), "Face7", "Solid1"):
        w.require(word in text, f"{word} is not in {text}")
    if w.PICTURES:
        await w.pause(500)
        w.save_screen("freecad_statistics.png")
        w.window.setGeometry(*w.WIDE)
    w.find("statistics").close()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plate.inp")
        with open(path, "w", encoding="utf-8") as file:
            file.write("of before")
        asked = []

        def overwrite():
            box = QtGui.QApplication.activeModalWidget()
            if not isinstance(box, QtGui.QMessageBox):
                QtCore.QTimer.singleShot(100, overwrite)
                return
            asked.append(box.text())
            box.button(QtGui.QMessageBox.Yes).click()

        def enter_name():
            dialog = next(
                (
                    each
                    for each in QtGui.QApplication.topLevelWidgets()
                    if isinstance(each, QtGui.QFileDialog)
                ),
                None,
            )
            if dialog is None:
                QtCore.QTimer.singleShot(100, enter_name)
                return
            filters = dialog.findChild(QtGui.QComboBox, "fileTypeCombo")
            while "(*.inp)" not in filters.currentText():
                down = QtGui.QKeyEvent(QtCore.QEvent.KeyPress, QtCore.Qt.Key_Down, QtCore.Qt.NoModifier)
                QtGui.QApplication.sendEvent(filters, down)
            dialog.findChild(QtGui.QLineEdit).setText(path.removesuffix(".inp"))
            QtCore.QTimer.singleShot(100, overwrite)
            dialog.accept()

        QtCore.QTimer.singleShot(300, enter_name)
        await menu_of(obj.Label, "export")
        await w.wait_until(lambda: os.path.getsize(path) > 1000, "the file")
        await w.pause(300)
        w.require(len(asked) == 1 and "plate.inp" in asked[0], f"before it overwrites it asks: {asked}")
        with open(path, encoding="utf-8") as file:
            w.require("NAME=FACE1," in file.read(), "faces have their names")


async def gmsh_and_back(document, part, obj):
    old = ObjectsFem.makeMeshGmsh(document, "FromGmsh")
    old.Part = part
    document.recompute()
    w.require("Take over by collarmesh" not in await menu_of(obj.Label), "ours need not be taken over")
    w.require("Take over by collarmesh" in await menu_of("FromGmsh", "take_over"), "the entry in Gmsh's menu")
    await w.wait_until(lambda: document.getObject("FromGmsh") is None, "the take over")
    new = next(each for each in document.Objects if each.Label == "FromGmsh")
    w.require(mesh_properties.is_ours(new), "it is ours")
    await menu_of("FromGmsh", "hand_over")
    await w.wait_until(lambda: any(take_over.mesher_of(each) for each in document.Objects), "the way back")
    document.undo()
    w.require(not any(take_over.mesher_of(each) for each in document.Objects), "undo of that")
    document.removeObject(next(each for each in document.Objects if each.Label == "FromGmsh").Name)


async def netgen_by_its_button(document, part):
    """In this version of FreeCAD, Netgen's object has no context menu in Python."""
    old = ObjectsFem.makeMeshNetgen(document, "FromNetgen")
    old.Shape = part
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(old)
    await w.click_command("Collarmesh_TakeOver")
    await w.wait_until(lambda: document.getObject("FromNetgen") is None, "the take over")
    new = next(each for each in document.Objects if each.Label == "FromNetgen")
    w.require(mesh_properties.is_ours(new), "it is ours")
    document.undo()
    w.require(document.getObject("FromNetgen") is not None, "undo of that")
    document.removeObject("FromNetgen")


async def undo_of_a_meshing_in_the_panel(document, obj):
    count = obj.FemMesh.VolumeCount
    await w.open_panel(obj)
    await w.run_mesher("2.5 mm")
    await w.close_panel()
    made = obj.FemMesh.VolumeCount
    w.require(made != count, "another mesh")
    document.undo()
    w.require(obj.FemMesh.VolumeCount == count, f"{obj.FemMesh.VolumeCount} in place of {count} after undo")
    document.redo()
    w.require(obj.FemMesh.VolumeCount == made, "redo")


async def buttons_are_grey_where_they_do_nothing(document, part, obj):
    commands = {MESH_COMMAND, REFINEMENT_COMMAND, GROUP_COMMAND, "Collarmesh_SizeSphere", "Collarmesh_SizeDistance",
                "Collarmesh_TakeOver"}
    gmsh = ObjectsFem.makeMeshGmsh(document, "OfGmsh")
    for_ours = {REFINEMENT_COMMAND, GROUP_COMMAND, "Collarmesh_SizeSphere", "Collarmesh_SizeDistance"}
    sizes = {"Collarmesh_SizeSphere", "Collarmesh_SizeDistance"}  # for the only mesh, or that of the selected part
    for chosen, clickable in (([], sizes), ([part], {MESH_COMMAND, *sizes}), ([part, document.Box], sizes),
                              ([obj], for_ours), ([document.Box], {MESH_COMMAND}), ([gmsh], {"Collarmesh_TakeOver"})):
        FreeCADGui.Selection.clearSelection()
        for each in chosen:
            FreeCADGui.Selection.addSelection(each)
        await w.pause(50)
        await w.wait_until(lambda: {each for each in commands if w.buttons_of(each)} == clickable,
                           f"{[each.Name for each in chosen]}: {[each for each in commands if w.buttons_of(each)]}", 5)
    document.removeObject(gmsh.Name)
    FreeCADGui.activateWorkbench("PartWorkbench")
    FreeCADGui.activateWorkbench("FemWorkbench")


async def a_second_click_opens_the_mesh_that_is_there(document, part, obj):
    """In an analysis, for the mesh of the analysis."""
    count = len(document.Objects)
    for _ in range(2):
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(part)
        await w.click_command(MESH_COMMAND)
        await w.wait_until(lambda: w.find("run") is not None, "the panel")
        w.require(FreeCADGui.ActiveDocument.getInEdit().Object is obj, "it is the panel of the mesh that is there")
    w.require(len(document.Objects) == count, "nothing is made")
    await w.close_panel(QtGui.QDialogButtonBox.Cancel)
    w.require(document.getObject(obj.Name) is obj, "Cancel leaves it")
    analysis = ObjectsFem.makeAnalysis(document, "Analysis")
    FemGui.setActiveAnalysis(analysis)
    FreeCADGui.Selection.addSelection(part)
    await w.click_command(MESH_COMMAND)
    await w.wait_until(lambda: w.find("run") is not None, "the panel")
    w.require(len(analysis.Group) == 1 and analysis.Group[0] is not obj, "an analysis has a mesh of its own")
    await w.close_panel()
    document.removeObject(analysis.Group[0].Name)
    document.removeObject(analysis.Name)
    FemGui.setActiveAnalysis()


async def cancel_removes_an_empty_new_mesh(document, part):
    """A new object that failed once stays empty; "OK" keeps it, with the values that were entered."""
    shape, names = part.Shape, {each.Name for each in document.Objects}

    async def click_the_button():
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(part)
        await w.click_command(MESH_COMMAND)
        await w.wait_until(lambda: w.find("run") is not None, "the panel")
        (new,) = [each for each in document.Objects if each.Name not in names]
        return new

    for fails in (False, True):
        steps = document.UndoCount
        await click_the_button()
        if fails:
            part.Shape = Part.Shell(Part.makeBox(1, 1, 1).Faces[:1])
            w.child("ElementDimension").setCurrentIndex(3)
            w.require("No mesh is made" in await w.run_mesher("2 mm"), w.said())
        await w.close_panel(QtGui.QDialogButtonBox.Cancel)
        await w.pause(100)
        w.require({each.Name for each in document.Objects} == names, "the empty mesh is gone")
        w.require(document.UndoCount == steps, "its creation is undone")
        part.Shape = shape
    new = await click_the_button()
    w.child("CharacteristicLengthMax").setText("3.5 mm")
    await w.close_panel()
    w.require(document.getObject(new.Name) is new and new.CharacteristicLengthMax.Value == 3.5, "OK keeps it")
    await w.open_panel(new)
    w.child("CharacteristicLengthMax").setText("2.5 mm")
    await w.close_panel(QtGui.QDialogButtonBox.Cancel)
    w.require(document.getObject(new.Name) is new and new.CharacteristicLengthMax.Value == 3.5, "it is no new one")
    await w.open_panel(new)
    w.child("CharacteristicLengthMax").setText("-1 mm")
    boxes = [box for box in w.window.findChildren(QtGui.QDialogButtonBox) if box.isVisible()]
    await w.click(boxes[0].button(QtGui.QDialogButtonBox.Ok))
    w.require("negative" in w.said(), "what makes no sense is told, and the panel stays")
    await w.close_panel(QtGui.QDialogButtonBox.Cancel)
    document.removeObject(new.Name)


async def undo_of_the_creation_while_meshing(document, part):
    """Deletes the object during its run."""
    before = len(document.Objects)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part)
    await w.click_command(MESH_COMMAND)
    await w.wait_until(lambda: w.find("run") is not None, "the panel")
    w.child("CharacteristicLengthMax").setText("0.25 mm")
    await w.click(w.child("run"))
    await w.wait_until(lambda: w.child("progress").value() > 0, "the run")
    name = document.Objects[-1].Name
    while document.getObject(name) is not None:
        w.require(document.UndoCount > 0, "the creation can be undone")
        document.undo()
        await w.pause(50)
    await w.pause(1000)
    w.require(len(document.Objects) == before, "it is gone")


async def triangles_by_the_button(document):
    triangles = document.addObject("Mesh::Feature", "Triangles")
    triangles.Mesh = Mesh.createSphere(5, 30)
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(triangles)
    await w.click_command(MESH_COMMAND)
    await w.wait_until(lambda: w.find("run") is not None, "the panel")
    obj = document.Objects[-1]
    said = await w.run_mesher("2 mm")
    w.require(obj.FemMesh.VolumeCount > 50, said)
    await w.close_panel()


async def the_mark_is_there_after_reopening(document, part, obj):
    part.Radius = 5
    document.recompute()
    w.require(up_to_date.is_out_of_date(obj), "it is out of date")
    name = obj.Name
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plate.FCStd")
        document.saveAs(path)
        FreeCAD.closeDocument(document.Name)
        document = FreeCAD.openDocument(path)
    obj = document.getObject(name)
    await w.pause(300)
    w.require(obj.ViewObject.Proxy.getIcon() == view_provider.OUT_OF_DATE_ICON, "the mark after reopening")
    document.getObject("Hole").Radius = 8
    document.recompute()
    w.require(obj.ViewObject.Proxy.getIcon() == view_provider.ICON, "and it goes")


async def test():
    document = FreeCAD.newDocument("document")
    document.UndoMode = 1
    box = document.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 40, 30, 5
    cylinder = document.addObject("Part::Cylinder", "Hole")
    cylinder.Radius, cylinder.Height = 6, 10
    cylinder.Placement.Base = FreeCAD.Vector(20, 15, -1)
    part = document.addObject("Part::Cut", "Plate")
    part.Base, part.Tool = box, cylinder
    document.recompute()
    FreeCADGui.activateWorkbench("FemWorkbench")
    obj = mesh_object.make(document, part)
    obj.CharacteristicLengthMax = 4
    mesh_object.remesh(obj)
    document.recompute()
    part.ViewObject.Visibility = False
    await w.pause(500)
    await a_changed_shape_marks_its_mesh(document, cylinder, obj)
    await mesh_again_by_the_menu(document, cylinder, obj)
    await statistics_and_export(obj)
    await gmsh_and_back(document, part, obj)
    await netgen_by_its_button(document, part)
    await undo_of_a_meshing_in_the_panel(document, obj)
    await buttons_are_grey_where_they_do_nothing(document, part, obj)
    await a_second_click_opens_the_mesh_that_is_there(document, part, obj)
    copy = document.addObject("Part::Feature", "Copy")
    copy.Shape = part.Shape
    await cancel_removes_an_empty_new_mesh(document, copy)
    await undo_of_the_creation_while_meshing(document, copy)
    await triangles_by_the_button(document)
    await the_mark_is_there_after_reopening(document, cylinder, obj)


w.run_test(test)
