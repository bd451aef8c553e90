"""The bounding boxes of parts and of their sub-shapes."""

import FreeCAD
import Part

from . import inputs


def bounding_box(part):
    """Returns the box of a shape or of a triangle mesh; an invalid one if there is none."""
    if part is None:
        return FreeCAD.BoundBox()
    mesh = inputs.triangles_of(part)
    if mesh is not None:
        return mesh.BoundBox
    shape = inputs.shape_of(part)
    return FreeCAD.BoundBox() if shape.isNull() else shape.BoundBox


def box_of_subshape(part, name):
    """Returns the box of a sub-shape such as Face7; an invalid one if the part does not have it."""
    try:
        return Part.getShape(part).getElement(name).BoundBox
    except (AttributeError, ValueError, IndexError, RuntimeError, Part.OCCError):
        return FreeCAD.BoundBox()


def diagonal(part):
    """Returns the diagonal of a part's box in mm; 0 without geometry."""
    box = bounding_box(part)
    return box.DiagonalLength if box.isValid() else 0
