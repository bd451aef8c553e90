"""The appearance of faces for constraints: each group has its own colour."""

import colorsys
import os

from . import compatibility, constraint_faces, views

ICON = os.path.join(views.ICONS, "group.svg")
STEP = 0.381966  # share of the colour wheel; it makes consecutive colours differ clearly


class ConstraintFacesViewProvider(compatibility.Stateless):
    def __init__(self, view):
        view.Proxy = self
        view.DisplayMode = "Flat Lines"
        view.LineWidth = 1

    def attach(self, view):
        self.ViewObject = view
        self.Object = view.Object

    def getIcon(self):
        return ICON

    def updateData(self, obj, name):
        if name == constraint_faces.GROUPS:  # the groups are set after the shape
            obj.ViewObject.DiffuseColor = colours(getattr(obj, name))


def colours(groups):
    """Returns for each face the colour of its group."""
    hues = {name: STEP * number % 1 for number, name in enumerate(dict.fromkeys(groups))}
    return [(*colorsys.hsv_to_rgb(hues[name], 0.35, 0.95), 0.0) for name in groups]


def show(mesh_object):
    """Shows the faces instead of the mesh and its part, and makes them if necessary. Raises MesherError."""
    faces = constraint_faces.make(mesh_object)
    for each in (mesh_object, compatibility.meshed_object(mesh_object)):
        each.ViewObject.Visibility = False
    faces.ViewObject.Visibility = True


def register():
    views.register(constraint_faces.TYPE, ConstraintFacesViewProvider)
