"""Handles other open panels: FreeCAD shows only one at a time, for all documents."""

import FreeCAD
import FreeCADGui

from .messages import say
from .translations import translate


def is_in_the_way():
    """Returns whether an open panel is in the way of editing an object, and tells the user if so. FreeCAD itself closes
    the panel of an object that is being edited, but no other panel."""
    documents = map(FreeCADGui.getDocument, FreeCAD.listDocuments())
    if not FreeCADGui.Control.activeDialog() or any(each.getInEdit() is not None for each in documents):
        return False
    say(translate("collarmesh", "Another panel is open; close it first."))
    return True
