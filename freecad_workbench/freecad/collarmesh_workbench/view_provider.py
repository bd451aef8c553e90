"""The appearance of the mesh object in the tree, and its reaction to a double click."""

import FreeCADGui

from . import compatibility, elements, layer_objects, mesh_menu, mesh_properties, size_objects, up_to_date, views
from .object_view import ObjectView
from .task_panel import MeshTaskPanel
from .views import ICON, OUT_OF_DATE_ICON


class MeshViewProvider(ObjectView):
    out_of_date = False
    panel = None  # set while the panel is open
    is_new = False  # the button has made the object, and it has no mesh yet
    hid_part = False  # the part was hidden when the mesh appeared

    def __init__(self, view):
        view.Proxy = self

    def getIcon(self):
        return OUT_OF_DATE_ICON if self.out_of_date else ICON

    def finishRestoring(self):
        up_to_date.show(self.Object)

    def show_out_of_date(self, out_of_date):
        """Marks the object in the tree and in its panel, or removes the mark."""
        if out_of_date != self.out_of_date:
            self.out_of_date = out_of_date
            self.ViewObject.signalChangeIcon()
        if self.panel is not None:
            self.panel.show_state(out_of_date)
        if self.Object.FemMesh.NodeCount == 0:  # undo has removed the mesh
            self.show_part_again()

    def show_in_place_of_part(self):
        """Hides the part when the mesh appears: a part at the same place would show through the mesh."""
        part = compatibility.meshed_object(self.Object)
        self.is_new = False
        if elements.dimension(self.Object.FemMesh) == 2:
            self.ViewObject.BackfaceCulling = False  # so that shells are visible from both sides
        self.ViewObject.show()
        if part is not None and part.ViewObject.Visibility:
            part.ViewObject.Visibility = False
            self.hid_part = True

    def show_part_again(self):
        """Shows the part again when the mesh disappears, if it was hidden for the mesh."""
        part = compatibility.meshed_object(self.Object)
        if self.hid_part and part is not None:
            part.ViewObject.Visibility = True
        self.hid_part = False

    def onDelete(self, _view, _names):
        self.show_part_again()
        return True

    def claimChildren(self):
        sizes = getattr(self.Object, size_objects.PROPERTY, [])
        layers = getattr(self.Object, layer_objects.PROPERTY, [])
        return [*self.Object.MeshRegionList, *sizes, *layers, *self.Object.MeshGroupList]

    def setupContextMenu(self, _view, menu):
        mesh_menu.fill(menu, self.Object)

    def new_panel(self):
        return MeshTaskPanel(self.Object)

    def unsetEdit(self, _view, _mode=0):
        self.panel = None
        FreeCADGui.Control.closeDialog()
        return True


def register():
    views.register(mesh_properties.TYPE, MeshViewProvider)
