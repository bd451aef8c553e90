"""Actions from Qt's main loop. FreeCAD's progress bar lets timers run in the middle of a recompute, when no document
may be changed: a recompute within another one, or an object that goes meanwhile, can end FreeCAD."""

import FreeCAD
from PySide import QtCore

AGAIN = 100  # milliseconds


def later(action, milliseconds=0):
    """Call `action` after this time, or when no document is recomputed any more."""
    QtCore.QTimer.singleShot(milliseconds, lambda: _try(action))


def _try(action):
    if any(each.Recomputing for each in FreeCAD.listDocuments().values()):
        later(action, AGAIN)
    else:
        action()
