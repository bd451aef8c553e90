"""The context menus of mesh objects: of ours and of those of FreeCAD's meshers."""

import FreeCADGui
from PySide import QtCore, QtGui

from . import compatibility, constraint_faces, constraint_faces_view, elements, mesh_file, result_refinement
from . import statistics_dialog, take_over
from .later import later
from .messages import say
from .program import MesherError
from .translations import translate


def fill(menu, obj):
    """Fills the menu of one of our mesh objects."""
    has_mesh = elements.is_there(obj.FemMesh)
    for name, text, action, enabled in (
        ("edit", translate("collarmesh", "Edit mesh"), edit, True),  # as on a double click
        ("mesh_again", translate("collarmesh", "Mesh again"), mesh_again, True),
        ("refine_by_result", translate("collarmesh", "Refine by result"),
         refine_by_result, result_refinement.is_possible(obj)),
        ("export", translate("collarmesh", "Export mesh..."), export, has_mesh),
        ("statistics", translate("collarmesh", "Statistics..."), statistics, has_mesh),
        ("constraint_faces", translate("collarmesh", "Faces for constraints"),
         constraint_faces_view.show, constraint_faces.can_be_made(obj)),
        ("hand_over", translate("collarmesh", "Hand over to Gmsh"), hand_over, True),
    ):
        _add(menu, name, text, action, obj).setEnabled(enabled)


def fill_for_others(menu, obj):
    """Fills the menu of a mesh object of Gmsh or Netgen."""
    _add(menu, "take_over", translate("collarmesh", "Take over by collarmesh"), take, obj)


def _add(menu, name, text, action, obj):
    entry = menu.addAction(text)
    entry.setObjectName("collarmesh_" + name)
    # Run the action later, when the menu is closed: it may remove the menu's object.
    entry.triggered.connect(lambda: later(lambda: _run(action, obj)))
    return entry


def _run(action, obj):
    QtGui.QApplication.setOverrideCursor(QtCore.Qt.WaitCursor)
    try:
        action(obj)
    except MesherError as error:
        say(str(error))
    finally:
        QtGui.QApplication.restoreOverrideCursor()


def edit(obj):
    """Opens the panel of the object and returns it; None if it cannot be opened."""
    document = FreeCADGui.getDocument(obj.Document.Name)
    if document.getInEdit():
        document.resetEdit()
    document.setEdit(obj.Name)
    return obj.ViewObject.Proxy.panel


def mesh_again(obj):
    """Opens the panel of the object and starts meshing."""
    panel = edit(obj)
    if panel is not None:
        panel.start()


def refine_by_result(obj):
    """Opens the panel of the object at the fields that refine its mesh by a result."""
    panel = edit(obj)
    if panel is not None:
        panel.refine.unfold()


def export(obj):
    QtGui.QApplication.restoreOverrideCursor()
    title = translate("collarmesh", "Export mesh")
    dialog = QtGui.QFileDialog(FreeCADGui.getMainWindow(), title, "", mesh_file.filters())
    dialog.setAcceptMode(QtGui.QFileDialog.AcceptSave)
    # Let the dialog add the extension, so that it asks before it overwrites a file.
    dialog.filterSelected.connect(lambda text: dialog.setDefaultSuffix(mesh_file.extension_in(text)))
    dialog.setDefaultSuffix(mesh_file.extension_in(dialog.selectedNameFilter()))
    dialog.selectFile(f"{obj.Label.replace('/', '_')}.{dialog.defaultSuffix()}")
    path = dialog.selectedFiles()[0] if dialog.exec_() else ""
    dialog.deleteLater()
    QtGui.QApplication.setOverrideCursor(QtCore.Qt.WaitCursor)
    if path:
        mesh_file.export(obj, path)


def statistics(obj):
    statistics_dialog.show(obj, FreeCADGui.getMainWindow())


def take(obj):
    _replaced(take_over.take_over(obj))


def hand_over(obj):
    _replaced(take_over.hand_over(obj))


def _replaced(result):
    obj, notes = result
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    if notes:
        say("\n".join(notes))


def install():
    """Adds entries to the context menus of FreeCAD's own mesh objects."""
    compatibility.extend_context_menus(fill_for_others)
