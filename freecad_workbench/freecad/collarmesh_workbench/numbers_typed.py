"""Numbers as users type and read them: with a decimal comma or point, with units, and as sums."""

import math
import sys

import FreeCAD
from PySide import QtCore

from .translations import translate


def shown(text):
    """Replaces the decimal points in a text of numbers by the decimal sign of the user's language."""
    return text.replace(".", QtCore.QLocale().decimalPoint())


def grouped(count):
    """Returns a whole number as text, with spaces between thousands."""
    return f"{count:,.0f}".replace(",", "\u202f")


def number(text):
    """Reads a plain number. Raises ValueError."""
    try:
        value = float(_with_point(text))
    except ValueError as error:
        raise ValueError(translate("collarmesh", "'{text}' is no number").format(text=text)) from error
    _require_finite(value, text)
    return value


def quantity(text, obj):
    """Reads a FreeCAD quantity: "2.5 mm", "1/8 in", "3 mm + 1 mm"; `obj` resolves names like Spreadsheet.width. Raises
    ValueError."""
    if not text.strip():
        raise ValueError(translate("collarmesh", "there is no value"))
    try:
        value = _parsed(_with_point(text), obj)
    except Exception as error:  # FreeCAD's exceptions have various base classes
        raise ValueError(translate("collarmesh", "'{text}' is no value").format(text=text)) from error
    _require_finite(value.Value, text)
    if value.Value == sys.float_info.min:  # FreeCAD's value for an empty text
        raise ValueError(translate("collarmesh", "'{text}' is no value").format(text=text))
    return value


def _parsed(text, obj):
    """Parses a quantity. Expressions are used only for sums and names, because they read "1/8 in" as one over eight
    inches."""
    try:
        return FreeCAD.Units.Quantity(text)
    except (ValueError, OSError):
        return FreeCAD.Units.Quantity(obj.evalExpression(text))


def _with_point(text):
    return text.strip().replace(",", ".")


def _require_finite(value, text):
    if not math.isfinite(value):
        raise ValueError(translate("collarmesh", "'{text}' is too large").format(text=text))
