"""The appearance of size objects: translucent in the 3D view, with handles to drag while their panel is open."""

import os

import FreeCADGui

from . import size_objects, views
from .object_view import ObjectView
from .size_panel import SizePanel

COLOUR = (0.91, 0.35, 0.05)
TRANSPARENCY = 75


def icon_of(kind):
    return os.path.join(views.ICONS, f"size_{kind.lower()}.svg")


class SizeViewProvider(ObjectView):
    def __init__(self, view):
        view.Proxy = self
        view.ShapeColor = view.LineColor = COLOUR
        view.Transparency = TRANSPARENCY
        view.LineWidth = 1.5
        if size_objects.kind_of(view.Object) == "Distance":
            view.LineWidth = 4
        view.Selectable = False  # so that the mouse can reach objects inside

    def getIcon(self):
        return icon_of(size_objects.kind_of(self.Object))

    def new_panel(self):
        return SizePanel(self.Object)

    def unsetEdit(self, _view, mode=0):
        if mode != 0:
            return None
        self.panel.close()
        FreeCADGui.Control.closeDialog()
        return True


def register():
    for kind in size_objects.KINDS.values():
        views.register(kind.Type, SizeViewProvider)
