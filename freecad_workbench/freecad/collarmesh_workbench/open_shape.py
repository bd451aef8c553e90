"""Shapes without a volume: their kinds, the elements that they can be meshed with, and the question whether
to close them. Works without the GUI."""

import collections

from . import inputs
from .program import MesherError
from .translations import translate

SEWN = 1e-5  # relative to the diagonal: faces this close count as meeting, as in the program
SHAPES = 5  # number of shapes whose open edges are remembered

_known = collections.deque(maxlen=SHAPES)  # (shape, number of its open edges)


def dimension(part, asked, fill_holes):
    """Returns the dimension of the elements: `asked` or, if that is 0, the dimension of the shape. It is 3 for solids,
    for closed surfaces and, with `fill_holes`, for all shapes with faces; 2 for other shapes with faces; 1 for
    wires."""
    if asked:
        return asked
    shape = _without_volume(part)
    if shape is None:
        return 3
    if not shape.Faces:
        return 1 if shape.Edges else 3
    return 3 if fill_holes or not open_edges(shape) else 2


def check(part, dimension_of_elements, fill_holes):
    """Raises MesherError if a shape cannot be meshed with elements of this dimension: wires, single faces and open
    surfaces (unless their holes may be filled) with tetrahedra, shapes without faces with triangles, shapes without
    edges with lines."""
    text = fault(part, dimension_of_elements)
    if not text and dimension_of_elements == 3 and not fill_holes and question(part):
        text = question(part) + " " + translate("collarmesh", "Or set “Fill holes of open surfaces”.")
    if text:
        raise MesherError(text)


def fault(part, dimension_of_elements=3):
    """Returns the reason why the shape cannot be meshed with elements of this dimension; "" if it can."""
    shape = inputs.shape_of(part)
    text = ""
    if dimension_of_elements == 2 and not shape.isNull() and not shape.Faces:
        text = translate("collarmesh",
                         "{label} has no face to be meshed with triangles: choose 1D in “Dimension of the elements”, "
                         "or make a face of it (Part: Face from wires).")
    elif dimension_of_elements == 1 and (shape.isNull() or not shape.Edges):
        text = translate("collarmesh", "{label} has no edges to be meshed with lines.")
    elif dimension_of_elements == 3:
        text = _fault_of_volume(_without_volume(part))
    return text.format(label=part.Label)


def _fault_of_volume(shape):
    if shape is None:
        return ""
    if not shape.Faces:
        return translate("collarmesh",
                         "{label} has edges or points only, and encloses no volume: choose 1D in “Dimension of the "
                         "elements” for beams, or make a solid of it (Part: Sweep).")
    if len(shape.Faces) == 1 and open_edges(shape):
        return translate("collarmesh",
                         "{label} is a face, which encloses no volume: choose 2D in “Dimension of the elements” for "
                         "shells, or make a solid of it (Part: Extrude).")
    return ""


def question(part):
    """Returns the question to ask before the holes of a surface are filled; "" if there are none."""
    shape = _without_volume(part)
    count = open_edges(shape) if shape is not None and len(shape.Faces) > 1 else 0
    if not count:
        return ""
    text = translate("collarmesh",
                     "{label} is a surface that is open at {count} edges, and encloses no volume. Choose 2D in "
                     "“Dimension of the elements” for shells, or close it and make a solid of it (Part: "
                     "Shape builder).")
    return text.format(label=part.Label, count=count)


def word(part, chosen):
    """Returns the panel's text on a dimension that follows from the shape; "" for solids."""
    text = {1: translate("collarmesh", "{label} has edges only: it is meshed with lines, for beams."),
            2: translate("collarmesh",
                         "{label} encloses no volume: it is meshed with triangles, for shells.")}.get(chosen, "")
    return text.format(label=part.Label)


def _without_volume(part):
    """Returns the shape of an object if it has no solids, else None."""
    shape = inputs.shape_of(part)
    return None if shape.isNull() or shape.Solids else shape


def open_edges(shape):
    """Returns the number of edges that border only one face after faces that meet are sewn."""
    found = next((count for known, count in _known if known.isSame(shape)), None)
    if found is None:
        found = _count_open_edges(shape)
        _known.append((shape, found))
    return found


def _count_open_edges(shape):
    sewn = shape.copy()
    sewn.sewShape(SEWN * shape.BoundBox.DiagonalLength)
    borders = {}
    for face in sewn.Faces:
        for edge in face.Edges:
            if not edge.Degenerated and not edge.isSeam(face):
                borders.setdefault(edge.hashCode(), []).append(edge)
    return sum(1 for edges in borders.values() for edge in edges
               if sum(1 for other in edges if other.isSame(edge)) == 1)
