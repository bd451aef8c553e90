"""The first part of the panel: the size of the elements, and their predicted number."""

from PySide import QtCore, QtGui

from . import numbers_typed, size_presets, widgets
from .quantity_field import POSITIVE, QuantityField
from .translations import translate
from .whole_table import WholeTable

NAME, SIZE, ELEMENTS, TIME = range(4)


class SizeSection(QtGui.QWidget):
    """A table of presets with predictions, and a field. Emits `changed` when another size is chosen."""

    changed = QtCore.Signal()

    def __init__(self, obj, diagonal):
        """Makes the section for a mesh object, whose size may be 0 for the default. `diagonal` is that of the
        shape's bounding box."""
        super().__init__()
        self.presets = size_presets.presets(diagonal)
        self.table = self._table()
        size = obj.CharacteristicLengthMax.Value
        if size == 0 and diagonal > 0:
            size = self.presets[len(self.presets) // 2][1]
        self.field = QuantityField("mm", size, obj, POSITIVE)
        self.field.widget.setObjectName("collarmesh_CharacteristicLengthMax")
        self.field.widget.setToolTip(translate("collarmesh", "Target length of the elements' edges"))
        row = QtGui.QFormLayout()
        self.label = translate("collarmesh", "Size of the elements")
        row.addRow(self.label, self.field.widget)
        widgets.stack(self, self.table, row)
        self._mark_row()
        self.table.currentItemChanged.connect(self._take_preset)
        self.field.widget.textChanged.connect(self._edited)

    def size(self):
        """Returns the size in mm. Raises ValueError, which names the field."""
        try:
            return self.field.value()
        except ValueError as error:
            raise ValueError(f"{self.label}: {error}") from error

    def sizes(self):
        """Returns the sizes of the table, in mm, the chosen one first."""
        return [size for size in (self._size_or_zero(), *(size for _, size in self.presets)) if size > 0]

    def show_predictions(self, predictions, missing=""):
        """Shows {size: (elements, seconds)}, with None for unknown seconds; `missing` is shown for sizes without an
        entry."""
        sizes = [size for _, size in self.presets]
        sizes.append(self._size_or_zero() if self._size_or_zero() not in sizes else 0)
        for row, size in enumerate(sizes):
            item = self.table.topLevelItem(row)
            tets, seconds = predictions.get(size, (0, 0))
            if tets > 0:
                item.setText(ELEMENTS, size_presets.count_text(tets))
                item.setText(TIME, "" if seconds is None else size_presets.duration_text(seconds))
            else:
                item.setText(ELEMENTS, missing if size > 0 and size not in predictions else "")
                item.setText(TIME, "")

    def _table(self):
        table = WholeTable((translate("collarmesh", "Fineness"), translate("collarmesh", "Size"),
                            translate("collarmesh", "≈ elements"), translate("collarmesh", "≈ time")))
        table.setObjectName("collarmesh_presets")
        table.setToolTip(translate("collarmesh", "Choose a size; how many elements it makes and how long that takes "
                                                 "is estimated for this shape"))
        for name, size in self.presets:
            item = table.add_row([name, _length(size) if size else "", "", ""])
            item.setData(NAME, QtCore.Qt.UserRole, size)
        table.add_row([translate("collarmesh", "Custom"), "", "", ""])
        return table

    def _custom_row(self):
        return self.table.topLevelItem(self.table.topLevelItemCount() - 1)

    def _size_or_zero(self):
        try:
            return self.size()
        except ValueError:
            return 0

    def _mark_row(self):
        """Marks the row of the size that is in the field."""
        size = self._size_or_zero()
        sizes = [preset for _, preset in self.presets]
        number = sizes.index(size) if size in sizes else len(sizes)
        self._custom_row().setText(SIZE, _length(size) if size > 0 and size not in sizes else "")
        self.table.blockSignals(True)
        self.table.setCurrentItem(self.table.topLevelItem(number))
        self.table.blockSignals(False)

    def _take_preset(self, item, _previous):
        size = item.data(NAME, QtCore.Qt.UserRole) if item is not None else None
        if size:
            self.field.show(size)
        elif item is not None:
            self.field.widget.setFocus()
            self.field.widget.selectAll()

    def _edited(self):
        self._mark_row()
        self.changed.emit()


def _length(size):
    return numbers_typed.shown(f"{size:g} mm")
