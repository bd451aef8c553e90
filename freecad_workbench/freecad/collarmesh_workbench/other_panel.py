"""FreeCAD shows one panel at a time, of whichever document: what to do when there is one already."""

import FreeCAD
import FreeCADGui

from .messages import say
from .translations import translate


def is_in_the_way():
    """Is a panel open that stays when an object is edited? Says so, then. FreeCAD closes those of edited objects."""
    documents = map(FreeCADGui.getDocument, FreeCAD.listDocuments())
    if not FreeCADGui.Control.activeDialog() or any(each.getInEdit() is not None for each in documents):
        return False
    say(translate("collarmesh", "Another panel is open; close it first."))
    return True
