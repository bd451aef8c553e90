"""The appearance of boundary layers: their faces in colour."""

import os

from . import layer_objects, size_view, views
from .layers_panel import LayersPanel

ICON = os.path.join(views.ICONS, "layers.svg")


class LayersViewProvider(size_view.SizeViewProvider):
    """Shows layers in the same way as sizes near faces, but with a panel of their own."""

    def getIcon(self):
        return ICON

    def new_panel(self):
        return LayersPanel(self.Object)


def register():
    views.register(layer_objects.TYPE, LayersViewProvider)
