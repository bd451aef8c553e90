"""The appearance of boundary layers: their faces in colour."""

import os

from . import layer_objects, size_view, views
from .layers_panel import LayersPanel

ICON = os.path.join(views.ICONS, "layers.svg")


class LayersViewProvider(size_view.SizeViewProvider):
    """Shows layers as sizes near faces are shown, with another panel."""

    def getIcon(self):
        return ICON

    def new_panel(self):
        return LayersPanel(self.Object)


def register():
    views.register(layer_objects.TYPE, LayersViewProvider)
