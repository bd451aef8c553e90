"""Fields for numbers with a unit: FreeCAD's own, which know units and expressions."""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui


def make(unit):
    """A QLineEdit for a quantity in "mm" or "deg"; a plain one where FreeCAD has none of its own."""
    field = FreeCADGui.UiLoader().createWidget("Gui::InputField") or QtGui.QLineEdit()
    field.setProperty("unit", unit)
    field.setMinimumWidth(60)
    return field


def quantity_in(field, unit):
    """The number in `unit` that the field holds. Raises ValueError."""
    text = field.text().replace(QtCore.QLocale().decimalPoint(), ".")
    try:
        quantity = FreeCAD.Units.Quantity(text)
        wanted = FreeCAD.Units.Quantity(1, FreeCAD.Units.Quantity(f"1 {unit}").Unit)
    except (ValueError, OSError) as error:
        raise ValueError(f"'{field.text()}' is no value: {error}") from error
    if quantity.Unit not in (wanted.Unit, FreeCAD.Units.Unit()):
        raise ValueError(f"'{field.text()}' is not in {unit}")
    return quantity.Value


def show(field, value, unit):
    """Put a number in `unit` into the field."""
    field.setText(FreeCAD.Units.Quantity(f"{value!r} {unit}").UserString)
