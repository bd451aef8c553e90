"""Handles other open panels: FreeCAD shows only one at a time, for all documents."""

import FreeCAD
import FreeCADGui

from .messages import say
from .translations import translate


def is_in_the_way():
    """Returns whether a panel is open that FreeCAD does not close when an object is edited, and tells the
    user. (It closes panels of edited objects.)"""
    documents = map(FreeCADGui.getDocument, FreeCAD.listDocuments())
    if not FreeCADGui.Control.activeDialog() or any(each.getInEdit() is not None for each in documents):
        return False
    say(translate("collarmesh", "Another panel is open; close it first."))
    return True
