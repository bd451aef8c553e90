"""Messages to the user."""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui


def say(text):
    """Shows a message without waiting for an answer."""
    FreeCAD.Console.PrintWarning(f"collarmesh: {text}\n")
    box = QtGui.QMessageBox(QtGui.QMessageBox.Information, "collarmesh", text, QtGui.QMessageBox.Ok,
                            FreeCADGui.getMainWindow())
    box.setObjectName("collarmesh_message_box")
    box.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    box.setModal(False)
    box.show()
