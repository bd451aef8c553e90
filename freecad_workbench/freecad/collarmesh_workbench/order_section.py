"""The part of the panel that asks for the order of the elements."""

from PySide import QtCore, QtGui

from . import widgets
from .translations import translate


NODES = {1: (2, 3), 2: (3, 6), 3: (4, 10)}  # numbers of nodes of elements, by dimension, for both orders


class OrderSection(QtGui.QWidget):
    """A form with a choice. Emits `changed` when another order is chosen."""

    changed = QtCore.Signal()

    def __init__(self, order):
        super().__init__()
        self.combo = QtGui.QComboBox()
        self.combo.setObjectName("collarmesh_ElementOrder")
        self.combo.addItems(["", ""])
        self.combo.setToolTip(translate("collarmesh", "Second order: mid-edge nodes, on the exact faces"))
        self.note = widgets.label("collarmesh_order_note", translate(
            "collarmesh", "First order is too stiff for bending: displacements come out too small, and stresses far "
            "too small. It is for a first look, and for solvers that ask for it."))
        row = widgets.form()
        row.addRow(translate("collarmesh", "Order of the elements"), self.combo)
        widgets.stack(self, row, self.note)
        self.show_dimension(3)
        self.combo.setCurrentIndex(order - 1)
        self._show_note()
        self.combo.currentIndexChanged.connect(self._choose)

    def order(self):
        """Returns the chosen order, 1 or 2."""
        return self.combo.currentIndex() + 1

    def show_dimension(self, dimension):
        """Shows the numbers of nodes of elements of this dimension."""
        for i, text in enumerate((translate("collarmesh", "first (straight, {n} nodes)"),
                                  translate("collarmesh", "second (curved, {n} nodes)"))):
            self.combo.setItemText(i, text.format(n=NODES[dimension][i]))

    def _choose(self, _index):
        self._show_note()
        self.changed.emit()

    def _show_note(self):
        self.note.setVisible(self.order() == 1)
