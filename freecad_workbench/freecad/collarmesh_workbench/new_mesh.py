"""Removal of a mesh object that the button has made and that the user does not want."""

import FreeCAD

from .translations import mark, translate

CREATION = mark("collarmesh", "FEM mesh from shape by collarmesh")  # name of the undo step that made it


def take_back(document_name, name):
    """Undoes the object's creation, or removes it if its creation was not the last step."""
    document = FreeCAD.listDocuments().get(document_name)
    if document is None or document.getObject(name) is None:
        return
    if document.UndoNames[:1] == [translate("collarmesh", CREATION)]:
        document.undo()
    if document.getObject(name) is not None:
        document.openTransaction(translate("collarmesh", "Cancel"))
        document.removeObject(name)
        document.commitTransaction()
