"""Where FreeCAD's versions differ."""

import FreeCAD
import ObjectsFem


class Stateless:
    """A proxy of which nothing is saved. FreeCAD 0.20 calls the first two methods, later versions the others."""

    def __getstate__(self):
        return None

    def __setstate__(self, _state):
        return None

    def dumps(self):
        return None

    def loads(self, _state):
        return None


def add_mesh_object(document, name):
    """An empty mesh object with a Python proxy. FreeCAD 1.0 has a base that knows the meshed shape."""
    try:
        return document.addObject("Fem::FemMeshShapeBaseObjectPython", name)
    except (RuntimeError, TypeError):
        return document.addObject("Fem::FemMeshObjectPython", name)


def shape_property(mesh_object):
    """The property that links the meshed object: `Shape` from FreeCAD 1.0 on, `Part` before."""
    return "Shape" if "Shape" in mesh_object.PropertiesList else "Part"


def meshed_object(mesh_object):
    return getattr(mesh_object, shape_property(mesh_object))


def make_refinement(document, mesh_object):
    """FreeCAD's object for a size on sub-shapes; later versions call it a refinement."""
    make = getattr(ObjectsFem, "makeMeshRegion", None) or ObjectsFem.makeMeshRefinement
    return make(document, mesh_object)


def make_group(document, mesh_object):
    return ObjectsFem.makeMeshGroup(document, mesh_object)


def as_number(button):
    """Standard buttons of panels as FreeCAD wants them; PySide6 (FreeCAD 1.x) has them as an enumeration."""
    return button.value if hasattr(button, "value") else int(button)


def has_gui():
    return bool(FreeCAD.GuiUp)
