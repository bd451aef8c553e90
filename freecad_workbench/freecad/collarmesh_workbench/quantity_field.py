"""Fields for numbers with a unit: "2.5 mm", "1/8 in", "(3 + 4) mm".

FreeCAD's own Gui::InputField is not for panels made in Python: of one that is gone a wrapper may stay (seen in 0.20.2),
which FEM's panels are then given for theirs, and fail."""

import FreeCAD
from PySide import QtCore, QtGui

from .translations import translate

ROUNDING = 1e-3  # relative: what FreeCAD's number of decimals may change in what is shown


class QuantityField:
    """A quantity in "mm" or "deg" in a QLineEdit, `widget`; text that is none is red. A number
    without a unit is in the one that the field has shown last, which depends on FreeCAD's preferences."""

    def __init__(self, unit, value):
        """`value` in `unit`."""
        self.unit = unit
        self.widget = QtGui.QLineEdit()
        self.widget.setMinimumWidth(60)
        self.show(value)
        self.widget.textChanged.connect(self._colour)

    def show(self, value):
        text, self._shown_unit, _ = FreeCAD.Units.Quantity(f"{value!r} {self.unit}").getUserPreferred()
        if abs(_parse(text).Value - value) > ROUNDING * abs(value):
            text, self._shown_unit = f"{value:.6g} {self.unit}", 1
        self._shown = value
        self.widget.setText(text)
        self._text = self.widget.text()

    def value(self):
        """In `unit`, exactly what was shown where nobody has edited it. Raises ValueError."""
        if self.widget.text() == self._text:
            return self._shown
        try:
            quantity = _parse(self.widget.text())
        except (ValueError, OSError) as error:
            raise ValueError(translate("collarmesh", "'{text}' is no value: {error}").format(
                text=self.widget.text(), error=error)) from error
        if quantity.Unit == FreeCAD.Units.Unit():
            return quantity.Value * self._shown_unit
        if quantity.Unit != _parse(f"1 {self.unit}").Unit:
            raise ValueError(translate("collarmesh", "'{text}' is not in {unit}").format(
                text=self.widget.text(), unit=self.unit))
        return quantity.Value

    def _colour(self, _text):
        try:
            self.value()
            self.widget.setStyleSheet("")
        except ValueError:
            self.widget.setStyleSheet("color: #c83c3c")


def _parse(text):
    return FreeCAD.Units.Quantity(text.replace(QtCore.QLocale().decimalPoint(), "."))
