"""The line of the panel that tells which faces of touching solids are one in the mesh."""

from PySide import QtCore, QtGui

from . import compatibility, contacts, inputs
from .translations import translate

MOST = 3  # that are named; the tool tip has all


class ContactsLabel(QtGui.QLabel):
    """Hidden where no solids touch."""

    def __init__(self, obj):
        super().__init__()
        self.object = obj
        self.setObjectName("collarmesh_contacts")
        self.setWordWrap(True)
        self.hide()
        self._timer = QtCore.QTimer(self, singleShot=True)
        self._timer.timeout.connect(self._look)
        self.look_soon()

    def look_soon(self):
        """At the shape, when the window has shown what is there already."""
        self._timer.start()

    def _look(self):
        names = self._names()
        self.setText(_text(names))
        self.setToolTip("\n".join(names))
        self.setVisible(bool(names))

    def _names(self):
        part = compatibility.meshed_object(self.object)
        if part is None:
            return []
        try:
            pairs = contacts.of(inputs.shape_of(part)).glued_faces()
        except Exception:  # of OpenCASCADE's, too; the run tells what is wrong
            return []
        return [f"Face{first}" if first == second else f"Face{first} = Face{second}" for first, second in pairs]


def _text(names):
    if len(names) == 1:
        text = translate("collarmesh", "The solids touch at {names}: they are glued there, and share the nodes.")
    else:
        text = translate("collarmesh", "The solids touch at {count} faces: they are glued there, and share the nodes "
                                       "({names}).")
    named = ", ".join(names[:MOST]) + (", ..." if len(names) > MOST else "")
    return text.format(count=len(names), names=named)
