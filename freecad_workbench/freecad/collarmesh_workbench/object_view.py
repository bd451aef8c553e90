"""The appearance of objects with a panel, and their reaction to a double click."""

import FreeCADGui

from . import compatibility, other_panel


class ObjectView(compatibility.Stateless):
    """A view provider. Derived classes have `new_panel`."""

    def attach(self, view):
        self.ViewObject = view
        self.Object = view.Object

    def setEdit(self, view, mode=0):
        if mode != 0:
            return None  # FreeCAD's own dragger, opened by "Transform" in the context menu
        if other_panel.is_in_the_way():
            return False
        view.show()
        self.panel = self.new_panel()
        FreeCADGui.Control.showDialog(self.panel)
        return True

    def doubleClicked(self, view):
        document = FreeCADGui.getDocument(view.Object.Document)
        if not document.getInEdit():
            document.setEdit(view.Object.Name)
        return True
