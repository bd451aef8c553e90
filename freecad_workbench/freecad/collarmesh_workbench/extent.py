"""How large the parts are that are meshed."""

import FreeCAD
import Part

from . import inputs


def bounding_box(part):
    """Of a shape or of a mesh of triangles; not valid where there is none."""
    if part is None:
        return FreeCAD.BoundBox()
    mesh = inputs.triangles_of(part)
    if mesh is not None:
        return mesh.BoundBox
    shape = inputs.shape_of(part)
    return FreeCAD.BoundBox() if shape.isNull() else shape.BoundBox


def box_of_subshape(part, name):
    """Of Face7, say; not valid where the part has none."""
    try:
        return Part.getShape(part).getElement(name).BoundBox
    except (AttributeError, ValueError, IndexError, RuntimeError, Part.OCCError):
        return FreeCAD.BoundBox()


def diagonal(part):
    """In mm; 0 where there is nothing."""
    box = bounding_box(part)
    return box.DiagonalLength if box.isValid() else 0
