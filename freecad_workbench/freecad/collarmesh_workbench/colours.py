"""Colours of text that is readable with light and dark themes."""

import FreeCADGui
from PySide import QtGui

GOOD, BAD, CARE, FAINT = range(4)
# Pairs of colours, of the text and of its background, for GOOD, BAD, CARE and FAINT.
_LIGHT = (("#1e7b47", "#e6f4ec"), ("#b82c2c", "#fbe9e9"), ("#8a5500", "#fdf2e0"), ("#606060", "#eeeeee"))
_DARK = (("#7fd8a0", "#17352a"), ("#ff8f8f", "#3c1d1d"), ("#f0b860", "#3a2c12"), ("#b4b4b4", "#2c2c2c"))


def of(kind):
    """Returns the colours of text and background for GOOD, BAD, CARE (warnings) or FAINT (unimportant). The text has
    its own background, because FreeCAD's themes have greys on which no colour is readable. Without a theme the
    background is "", which stands for no change."""
    ink, paper = (_DARK if is_dark() else _LIGHT)[kind]
    return ink, paper if QtGui.QApplication.instance().styleSheet() else ""


def css(kind):
    """Returns the colours of `of` for style sheets and rich text."""
    ink, paper = of(kind)
    return f"color: {ink}; background-color: {paper}" if paper else f"color: {ink}"


def paint(item, column, kind):
    """Colours a text in a tree or a table."""
    ink, paper = of(kind)
    item.setForeground(column, QtGui.QColor(ink))
    if paper:
        item.setBackground(column, QtGui.QColor(paper))


def is_dark():
    """Returns whether the theme is dark. Themes are style sheets, so only the colours of a widget in the window can
    tell."""
    probe = QtGui.QLabel(FreeCADGui.getMainWindow())
    probe.ensurePolished()
    ink = probe.palette().color(QtGui.QPalette.WindowText)
    probe.setParent(None)
    return ink.lightness() > 128
