"""The common part of the panels of objects whose changes take effect at once."""

import FreeCADGui
from PySide import QtGui

from . import compatibility


class EditPanel:
    """A panel. All changes are one undo step, together with the creation of a new object; "Cancel" undoes
    them."""

    def __init__(self, obj, title, name):
        """`name`: the name of the form, by which it is found."""
        self.object = obj
        self.filling = False  # whether the fields are being filled, which is no change of the object
        if not obj.Document.HasPendingTransaction:
            obj.Document.openTransaction(title)
        self.form = QtGui.QWidget()
        self.form.setObjectName(name)
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(QtGui.QIcon(obj.ViewObject.Proxy.getIcon()))

    def close(self):
        """Closes the panel and removes its marks from the 3D view."""

    def getStandardButtons(self):
        return compatibility.as_number(QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel)

    def accept(self):
        document = self.object.Document
        document.commitTransaction()
        FreeCADGui.getDocument(document.Name).resetEdit()
        document.recompute()
        return True

    def reject(self):
        document = self.object.Document
        self.close()
        document.abortTransaction()  # this also removes a new object, which the end of the edit would commit
        FreeCADGui.getDocument(document.Name).resetEdit()
        document.recompute()
        return True
