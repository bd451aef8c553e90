"""The part of the panel that shows at which faces solids touch, and asks whether to keep them apart there."""

from PySide import QtCore, QtGui

from . import compatibility, contacts, inputs, widgets
from .translations import translate

MOST = 3  # number of faces named; the tool tip lists all


class ContactsSection(QtGui.QWidget):
    """A form that is hidden if no solids touch. Emits `changed` when the box is ticked or unticked."""

    changed = QtCore.Signal()

    def __init__(self, obj):
        super().__init__()
        self.object = obj
        self._names = []
        self.label = widgets.label("collarmesh_contacts")
        self.box = QtGui.QCheckBox(translate("collarmesh", "Keep touching solids apart"))
        self.box.setObjectName("collarmesh_KeepApart")
        self.box.setToolTip(translate("collarmesh",
                                      "Give each solid nodes of its own where solids touch, for contact and "
                                      "tie constraints; otherwise they are glued"))
        self.box.setChecked(obj.KeepApart)
        self.box.toggled.connect(self._toggled)
        widgets.stack(self, self.label, self.box)
        self.hide()
        self._timer = QtCore.QTimer(self, singleShot=True)
        self._timer.timeout.connect(self._look)
        self.look_soon()

    def look_soon(self):
        """Looks at the shape after the window has been redrawn."""
        self._timer.start()

    def store(self):
        """Stores the value in the object's property."""
        if self.box.isChecked() != self.object.KeepApart:
            self.object.KeepApart = self.box.isChecked()

    def apply_to(self, settings):
        settings.keep_apart = self.box.isChecked()

    def _toggled(self, _checked):
        self._show()
        self.changed.emit()

    def _look(self):
        self._names = self._names_of_faces()
        self._show()

    def _show(self):
        self.label.setText(_text(self._names, self.box.isChecked()))
        self.label.setToolTip("\n".join(self._names))
        self.setVisible(bool(self._names))

    def _names_of_faces(self):
        part = compatibility.meshed_object(self.object)
        if part is None:
            return []
        try:
            pairs = contacts.of(inputs.shape_of(part)).glued_faces()
        except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
            return []
        return [f"Face{first}" if first == second else f"Face{first} = Face{second}" for first, second in pairs]


def _text(names, apart):
    named = ", ".join(names[:MOST]) + (", ..." if len(names) > MOST else "")
    if len(names) == 1:
        places = translate("collarmesh", "The solids touch at {names}:")
    else:
        places = translate("collarmesh", "The solids touch at {count} faces ({names}):")
    if apart:
        held = translate("collarmesh", "they are kept apart there, each with nodes of its own.")
    else:
        held = translate("collarmesh", "they are glued there, and share the nodes.")
    return f"{places.format(count=len(names), names=named)} {held}"
