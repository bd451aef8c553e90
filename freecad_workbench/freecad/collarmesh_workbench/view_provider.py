"""How the mesh object looks in the tree, and what a double click does."""

import os

import FreeCADGui

from . import compatibility

ICON = os.path.join(os.path.dirname(__file__), "icons", "collarmesh.svg")


class MeshViewProvider(compatibility.Stateless):
    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        self.ViewObject = view
        self.Object = view.Object

    def getIcon(self):
        return ICON

    def claimChildren(self):
        return [*self.Object.MeshRegionList, *self.Object.MeshGroupList]

    def setEdit(self, view, mode=0):
        from .task_panel import MeshTaskPanel

        if mode != 0:
            return None
        view.show()
        FreeCADGui.Control.showDialog(MeshTaskPanel(view.Object))
        return True

    def unsetEdit(self, _view, _mode=0):
        FreeCADGui.Control.closeDialog()
        return True

    def doubleClicked(self, view):
        document = FreeCADGui.getDocument(view.Object.Document)
        if not document.getInEdit():
            document.setEdit(view.Object.Name)
        return True
