"""Fields for numbers with a unit: "2.5 mm", "1/8 in", "3 mm + 1 mm".
FreeCAD's own Gui::InputField cannot be used in panels made in Python: a Python wrapper of a deleted one may
remain (seen in 0.20.2); FEM's panels then get it in place of their own field, and fail."""

import FreeCAD
from PySide import QtGui

from . import colours, numbers_typed
from .translations import translate

ROUNDING = 1e-3  # largest relative change by rounding to FreeCAD's number of decimals
ANY, NOT_NEGATIVE, POSITIVE = range(3)


class QuantityField:
    """A quantity in "mm" or "deg" in a QLineEdit, `widget`. Text that is no quantity is shown in red. A
    number without a unit has the unit that the field has shown last, which depends on FreeCAD's preferences."""

    def __init__(self, unit, value, obj, allowed=NOT_NEGATIVE, zero=""):
        """`value` in `unit`; `obj` resolves names in the text; `zero`: the meaning of 0 and of an empty field."""
        self.unit, self.obj = unit, obj
        self.allowed, self.zero = allowed, zero
        self.widget = QtGui.QLineEdit()
        self.widget.setMinimumWidth(60)
        self.widget.setPlaceholderText(zero)
        self.show(value)
        self.widget.textChanged.connect(self._colour)

    def show(self, value):
        text, self._shown_unit, _ = FreeCAD.Units.Quantity(f"{value!r} {self.unit}").getUserPreferred()
        if abs(numbers_typed.quantity(text, self.obj).Value - value) > ROUNDING * abs(value):
            text, self._shown_unit = f"{value:.6g} {self.unit}", 1
        self._shown = value
        self.widget.setText("" if value == 0 and self.zero else text)
        self._text = self.widget.text()

    def value(self):
        """Returns the value in `unit`: exactly the shown one if it was not edited. Raises ValueError."""
        value = self._shown if self.widget.text() == self._text else self._typed(self.widget.text())
        if value < 0 and self.allowed != ANY:
            raise ValueError(translate("collarmesh", "'{text}' is negative").format(text=self.widget.text()))
        if value == 0 and self.allowed == POSITIVE:
            raise ValueError(translate("collarmesh", "it has to be more than 0"))
        return value

    def _typed(self, text):
        if not text.strip() and self.zero:
            return 0.0
        quantity = numbers_typed.quantity(text, self.obj)
        if quantity.Unit == FreeCAD.Units.Unit():
            return quantity.Value * self._shown_unit
        if quantity.Unit != FreeCAD.Units.Quantity(f"1 {self.unit}").Unit:
            raise ValueError(translate("collarmesh", "'{text}' is not in {unit}").format(text=text, unit=self.unit))
        return quantity.Value

    def _colour(self, _text):
        try:
            self.value()
            self.widget.setStyleSheet("")
        except ValueError:
            self.widget.setStyleSheet(colours.css(colours.BAD))
