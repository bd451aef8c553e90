"""Runs actions from Qt's main loop. FreeCAD's progress bar runs timers in the middle of a recompute, when no
document may be changed: a nested recompute, or an object deleted meanwhile, can crash FreeCAD."""

import FreeCAD
from PySide import QtCore

AGAIN = 100  # milliseconds between attempts


def later(action, milliseconds=0):
    """Calls `action` after this time. If a document is being recomputed then, waits for the end of the recompute."""
    QtCore.QTimer.singleShot(milliseconds, lambda: _try(action))


def _try(action):
    if any(each.Recomputing for each in FreeCAD.listDocuments().values()):
        later(action, AGAIN)
    else:
        action()
