"""Colours of words, which can be read on light and on dark themes."""

import FreeCADGui
from PySide import QtGui

GOOD, BAD, CARE, FAINT = range(4)
_ON_LIGHT = ("#1e7b47", "#b82c2c", "#8a5500", "#707070")
_ON_DARK = ("#7fd8a0", "#ff8f8f", "#f0b860", "#a8a8a8")


def of(kind):
    """What to write good news, bad ones, warnings and what does not count in."""
    return (_ON_DARK if is_dark() else _ON_LIGHT)[kind]


def is_dark():
    """Is the theme? Themes are style sheets, so that only a widget of the window knows."""
    probe = QtGui.QLabel(FreeCADGui.getMainWindow())
    probe.ensurePolished()
    ink = probe.palette().color(QtGui.QPalette.WindowText)
    probe.setParent(None)
    return ink.lightness() > 128
