"""FreeCAD's dock, which shows the panels."""

import contextlib

import FreeCADGui
from PySide import QtCore, QtGui


def widen(form, width):
    """Makes room for a panel's whole width (pixels), once it is in its dock, which only shows what fits."""
    QtCore.QTimer.singleShot(0, lambda: _widen(form, width))


def _widen(form, width):
    window = FreeCADGui.getMainWindow()
    with contextlib.suppress(RuntimeError):  # the panel is closed already
        for dock in window.findChildren(QtGui.QDockWidget):
            if dock.isAncestorOf(form) and not dock.isFloating() and dock.width() < width:
                window.resizeDocks([dock], [width], QtCore.Qt.Horizontal)
