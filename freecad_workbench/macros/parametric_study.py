"""Varies a parameter of a shape, and meshes the part again each time, in the same mesh object."""

import FreeCAD
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import mesh_object as collarmesh_object

document = FreeCAD.newDocument("parametric_study")
box = document.addObject("Part::Box", "Box")
box.Length, box.Width, box.Height = 30, 20, 10
hole = document.addObject("Part::Cylinder", "Hole")
hole.Height = 10
hole.Placement.Base = FreeCAD.Vector(15, 10, 0)
part = document.addObject("Part::Cut", "Part")
part.Base, part.Tool = box, hole
hole.Radius = 1
document.recompute()

mesh_object = collarmesh_workbench.mesh(part, size=2)
table = []  # radius in mm, elements, volume of the shape in mm^3, smallest dihedral angle in degrees
for radius in (2, 4, 6, 8):
    hole.Radius = radius
    document.recompute()
    report = collarmesh_object.remesh(mesh_object)
    table.append((radius, report["mesh"]["tets"], part.Shape.Volume, report["mesh"]["min_dihedral"]))
for radius, elements, volume, angle in table:
    FreeCAD.Console.PrintMessage(f"radius {radius} mm: {elements} elements, {volume:.0f} mm3, {angle:.1f} degrees\n")
