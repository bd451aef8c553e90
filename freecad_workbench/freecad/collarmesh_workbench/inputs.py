"""Objects that can be meshed: any object with a shape (bodies, compounds, links, also to other documents), and triangle
meshes."""

import numpy
import Part

from .program import MesherError
from .translations import translate

KINDS = ("Part::Feature", "App::Part", "App::LinkGroup", "Mesh::Feature")
REST = "Rest"  # the group of triangles that are in no segment


def triangles_of(part):
    """Returns the `Mesh` of a `Mesh::Feature` or of a link to one, placed as shown; None for other objects."""
    linked = part.getLinkedObject(True)
    if linked is None or not linked.isDerivedFrom("Mesh::Feature"):
        return None
    if linked is part:
        return part.Mesh
    mesh = linked.Mesh.copy()
    mesh.Placement = part.LinkPlacement * linked.Placement if part.LinkTransform else part.LinkPlacement
    return mesh


def shape_of(part):
    """Returns the shape of an object, with its placement; a null shape if it has none, like triangle meshes."""
    shape = getattr(part, "Shape", None)
    if hasattr(shape, "exportBrep"):
        return shape
    return Part.Shape() if part.isDerivedFrom("Mesh::Feature") else Part.getShape(part)


def can_be_meshed(obj):
    """Returns whether meshing may work. Called often, so it only checks kinds; shapes that are no closed
    solids are rejected when they are meshed."""
    linked = obj.getLinkedObject(True)
    return linked is not None and any(linked.isDerivedFrom(kind) for kind in KINDS)


def file_name(part):
    """Returns a file name for `write`, with the extension of a suitable format."""
    return "shape.brep" if triangles_of(part) is None else "triangles.msh"


def write(part, path):
    """Writes the shape, or the triangles with their segments as groups. Raises MesherError without geometry."""
    mesh = triangles_of(part)
    if mesh is None:
        shape = shape_of(part)
        if shape.isNull():
            raise MesherError(translate("collarmesh", "{label} has no shape; recompute it."), label=part.Label)
        shape.exportBrep(path)
    elif mesh.CountFacets == 0:
        raise MesherError(translate("collarmesh", "{label} has no triangles."), label=part.Label)
    else:
        write_triangles(mesh, path)


def segments(mesh):
    """Returns for each triangle the number of its segment, from 1: the first one if it is in several, 0 if it
    is in none."""
    numbers = numpy.zeros(mesh.CountFacets, dtype=int)
    for number in range(mesh.countSegments(), 0, -1):
        numbers[numpy.array(mesh.getSegment(number - 1), dtype=int)] = number
    return numbers


def write_triangles(mesh, path):
    """Writes triangles as .msh 2.2; segments are physical groups. Without segments the triangles have no tags, so that
    the program finds the faces by their angles."""
    points, triangles = mesh.Topology
    numbers = segments(mesh)
    count = mesh.countSegments()
    if count:
        numbers[numbers == 0] = count + 1
    names = {number: REST if number > count else f"Segment{number}" for number in sorted(set(numbers)) if number}
    sections = [("MeshFormat", ["2.2 0 8"])]
    if names:
        sections.append(("PhysicalNames", [len(names), *(f'2 {n} "{name}"' for n, name in names.items())]))
    sections.append(("Nodes", [len(points), *(f"{i} {p.x!r} {p.y!r} {p.z!r}" for i, p in enumerate(points, 1))]))
    sections.append(("Elements", [len(triangles), *(f"{i} 2 2 {n} {n} {a + 1} {b + 1} {c + 1}" for i, (n, (a, b, c))
                                                    in enumerate(zip(numbers, triangles), 1))]))
    with open(path, "w", encoding="ascii") as file:
        for name, lines in sections:
            print(f"${name}", *lines, f"$End{name}", sep="\n", file=file)
