"""Shapes without a volume: what they are, and whether they may be closed. Works without the GUI."""

from . import inputs
from .program import MesherError
from .translations import translate

SEWN = 1e-5  # of the diagonal: faces as near as this meet, as in the program


def check(part, fill_holes):
    """Raises MesherError for wires, faces, and surfaces that are open, unless their holes may be filled."""
    text = fault(part)
    if not text and not fill_holes and question(part):
        text = question(part) + " " + translate("collarmesh", "Or set “Fill holes of open surfaces”.")
    if text:
        raise MesherError(text)


def fault(part):
    """Why no volume can be made of it; "" where one may be."""
    shape = _without_volume(part)
    if shape is None:
        return ""
    text = ""
    if not shape.Faces:
        text = translate("collarmesh", "{label} has edges or points only. Meshes of volumes are made here, not of beams: make a "
                                       "solid of it (Part: Sweep), or mesh it by Gmsh.")
    elif len(shape.Faces) == 1 and open_edges(shape):
        text = translate("collarmesh", "{label} is a face, which encloses no volume. Meshes of volumes are made here, not of "
                                       "shells: make a solid of it (Part: Extrude), or mesh it by Gmsh.")
    return text.format(label=part.Label)


def question(part):
    """What to ask before the holes of a surface are filled; "" where there are none."""
    shape = _without_volume(part)
    count = open_edges(shape) if shape is not None and len(shape.Faces) > 1 else 0
    if not count:
        return ""
    text = translate("collarmesh", "{label} is a surface that is open at {count} edges, and encloses no volume. Close it and make "
                                   "a solid of it (Part: Shape builder), or mesh it as a shell by Gmsh.")
    return text.format(label=part.Label, count=count)


def _without_volume(part):
    """The shape of an object that has no solids; None for others."""
    shape = inputs.shape_of(part)
    return None if shape.isNull() or shape.Solids else shape


def open_edges(shape):
    """How many edges of its faces border one face only, when faces that meet are sewn."""
    sewn = shape.copy()
    sewn.sewShape(SEWN * shape.BoundBox.DiagonalLength)
    borders = {}
    for face in sewn.Faces:
        for edge in face.Edges:
            if not edge.Degenerated and not edge.isSeam(face):
                borders.setdefault(edge.hashCode(), []).append(edge)
    return sum(1 for edges in borders.values() for edge in edges
               if sum(1 for other in edges if other.isSame(edge)) == 1)
