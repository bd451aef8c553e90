"""Numbers as people type and read them: with a decimal comma or point, with units, and as sums."""

import math
import sys

import FreeCAD
from PySide import QtCore

from .translations import translate


def shown(text):
    """A text of numbers with a decimal point, with the sign that the user's language has for it."""
    return text.replace(".", QtCore.QLocale().decimalPoint())


def number(text):
    """A plain number. Raises ValueError."""
    try:
        value = float(_with_point(text))
    except ValueError as error:
        raise ValueError(translate("collarmesh", "'{text}' is no number").format(text=text)) from error
    _require_finite(value, text)
    return value


def quantity(text, obj):
    """A FreeCAD quantity: "2.5 mm", "1/8 in", "3 mm + 1 mm"; `obj` knows names like Spreadsheet.width. Raises
    ValueError."""
    if not text.strip():
        raise ValueError(translate("collarmesh", "there is no value"))
    try:
        value = _parsed(_with_point(text), obj)
    except Exception as error:  # FreeCAD's exceptions have many base classes
        raise ValueError(translate("collarmesh", "'{text}' is no value").format(text=text)) from error
    _require_finite(value.Value, text)
    if value.Value == sys.float_info.min:  # FreeCAD's value of an empty text
        raise ValueError(translate("collarmesh", "'{text}' is no value").format(text=text))
    return value


def _parsed(text, obj):
    """Expressions are for sums and names only: "1/8 in" is one over eight inches there."""
    try:
        return FreeCAD.Units.Quantity(text)
    except (ValueError, OSError):
        return FreeCAD.Units.Quantity(obj.evalExpression(text))


def _with_point(text):
    return text.strip().replace(",", ".")


def _require_finite(value, text):
    if not math.isfinite(value):
        raise ValueError(translate("collarmesh", "'{text}' is too large").format(text=text))
