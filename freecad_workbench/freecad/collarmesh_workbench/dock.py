"""FreeCAD's dock, in which panels are shown."""

import contextlib

import FreeCADGui
from PySide import QtCore, QtGui


def widen(form, width):
    """Widens the dock, if it is narrower, to this width (pixels) as soon as the panel is in it."""
    QtCore.QTimer.singleShot(0, lambda: _widen(form, width))


def _widen(form, width):
    window = FreeCADGui.getMainWindow()
    with contextlib.suppress(RuntimeError):  # the panel may be closed already
        for dock in window.findChildren(QtGui.QDockWidget):
            if dock.isAncestorOf(form) and not dock.isFloating() and dock.width() < width:
                window.resizeDocks([dock], [width], QtCore.Qt.Horizontal)
