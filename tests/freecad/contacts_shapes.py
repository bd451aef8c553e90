"""Solids that touch, and measurements of their meshes. For tests run by run.py."""

import FreeCAD
import Part

BESIDE = FreeCAD.Vector(10, 0, 0)


def boxes():
    """Two boxes: Face2 and Face7 coincide."""
    return Part.makeCompound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, BESIDE)])


def hub():
    """A hub in the bore of a plate: Face7 is a part of Face8, its curved side."""
    plate = Part.makeBox(40, 40, 10).cut(Part.makeCylinder(8, 10, FreeCAD.Vector(20, 20, 0)))
    return Part.makeCompound([plate, Part.makeCylinder(8, 20, FreeCAD.Vector(20, 20, -5))])


def boss():
    """A boss on a plate: Face9, its foot, is a part of Face6."""
    return Part.makeCompound([Part.makeBox(20, 20, 5), Part.makeCylinder(4, 6, FreeCAD.Vector(10, 10, 5))])


def groups(fem_mesh):
    return {fem_mesh.getGroupName(n): fem_mesh.getGroupElements(n) for n in fem_mesh.Groups}


def area(fem_mesh, elements):
    total = 0
    for element in elements:
        a, b, c = (fem_mesh.getNodeById(n) for n in fem_mesh.getElementNodes(element)[:3])
        total += (b - a).cross(c - a).Length / 2
    return total
