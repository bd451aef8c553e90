"""The cost of a mesh, and the question to ask before an expensive one is made. Works without the GUI."""

import math

from . import inputs
from .size_presets import count_text, duration_text
from .translations import translate

MANY = 5_000_000  # number of elements
BYTES = {1: 1000, 2: 2000}  # bytes that the mesher, and after it FreeCAD, needs per element, by order
GIGABYTE = 1e9
LOADING = {1: 5e-6, 2: 12e-6}  # seconds per element that FreeCAD takes to read it, by order


def elements_by_extent(part, size, dimension=3):
    """Estimates the number of elements of one size (mm) in a part: regular tetrahedra, equilateral triangles, or
    lines."""
    mesh, shape = inputs.triangles_of(part), inputs.shape_of(part)
    if mesh is None and shape.isNull():
        return 0
    if dimension == 3:
        return 6 * math.sqrt(2) * abs(shape.Volume if mesh is None else mesh.Volume) / size**3
    if dimension == 2:
        return 4 / math.sqrt(3) * (shape.Area if mesh is None else mesh.Area) / size**2
    return 0 if mesh is not None else sum(edge.Length for edge in shape.Edges) / size


def estimates(part, sizes, dimension):
    """Returns {size: (elements, None)} for meshes of triangles or lines, which the program does not predict. Ignores
    curvature and small faces."""
    return {} if part is None else {size: (elements_by_extent(part, size, dimension), None)
                                    for size in sizes if size > 0}


def loading_seconds(elements, order):
    return LOADING[order] * elements


def free_memory():
    """Returns the free memory in bytes; infinite if unknown."""
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            lines = dict(line.split(":", 1) for line in file)
        return 1024 * int(lines["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        return math.inf


def question(elements, order, seconds=None):
    """Returns the question to ask before this many elements are made; "" for none. `seconds` may be None:
    unknown."""
    needed, free = BYTES[order] * elements, free_memory()
    if elements <= MANY and needed <= free:
        return ""
    text = translate("collarmesh", "This size makes about {elements} elements.").format(elements=count_text(elements))
    if seconds is not None:
        text += " " + translate("collarmesh", "That takes about {time}.").format(time=duration_text(seconds))
    memory = translate("collarmesh", "They need about {needed} GB of memory.")
    if needed > free:
        memory = translate("collarmesh", "They need about {needed} GB of memory, but {free} GB are free.")
    return f"{text} {memory}".format(needed=_gigabytes(needed), free=_gigabytes(free))


def _gigabytes(count):
    return count_text(count / GIGABYTE) if count >= 10 * GIGABYTE else f"{count / GIGABYTE:.1f}"
